#include <algorithm>
#include <charconv>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/results/frame_series.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/session/later.hpp"
#include "pyroclast/session/session.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

/// Throws Error where a checkpoint is not one of this program, these inputs and this body.
/// \param other_inputs  description of inputs that are not these, for the message
void require_same(const CheckpointFile& checkpoint, const std::string& inputs, const Simulation& simulation,
                  const char* other_inputs =
                      "other inputs: deck.toml or a file of inputs/ was changed since "
                      "the run began") {
  const CheckpointInfo& info = checkpoint.info();
  const auto refuse = [&](const std::string& what) {
    throw Error(fmt::format("{}: {}", checkpoint.path().string(), what));
  };
  if (info.version != kVersion)
    refuse(fmt::format("was written by pyroclast {}; this is {}, whose steps may give other bits",
                       info.version, kVersion));
  if (info.physics_version != kPhysicsVersion)
    refuse(fmt::format("belongs to physics version {}; this program has {}", info.physics_version,
                       kPhysicsVersion));
  if (info.inputs != inputs) refuse(fmt::format("belongs to {}", other_inputs));
  if (const int blocks = blocks_of_a_chunk(simulation.model().dimension()); info.blocks_of_a_chunk != blocks)
    refuse(
        fmt::format("was written with chunks of {} blocks, and this run has chunks of {}, see "
                    "PYROCLAST_CHUNK_BLOCKS",
                    info.blocks_of_a_chunk, blocks));
  if (info.body != body_hash(simulation))
    refuse("belongs to another body: specimen or laws of this program differ from those that the run had");
}

DeckOfRun open_from(const fs::path& run, const std::vector<std::string>& changes, const Appendix& more,
                    RunChoices choices) {
  choices.seed.reset();  // the folder's deck has the seed
  if (const auto body = RunFolder::body(run); body && is_there(*body)) choices.body = body->folder;
  return {Deck::open(run / RunFolder::kDeck, changes, more), run, std::move(choices)};
}

/// Returns the stage with this number or name, from 0.
std::int64_t stage_of(const std::string& stated, const Setup& setup) {
  std::int64_t number = 0;
  const auto count = static_cast<std::int64_t>(setup.stages.size());
  const auto [end, error] = std::from_chars(stated.data(), stated.data() + stated.size(), number);
  if (error == std::errc{} && end == stated.data() + stated.size()) {
    if (number >= 0 && number < count) return number;
    throw Error(fmt::format("stage {}: the run has stages 0 to {}", stated, count - 1));
  }
  const auto& names = setup.stage_names;
  const auto found = std::ranges::count(names, stated);
  if (found == 1) return std::ranges::find(names, stated) - names.begin();
  throw Error(fmt::format("stage {}: {} of the stages have this name; they are, from 0 on: {}", stated, found,
                          fmt::join(names, ", ")));
}

/// Throws Error for a run that a script changed: its checkpoints do not hold what the script does.
void require_deck_alone(const fs::path& run) {
  for (const Departure& departure : RunFolder::departures(run))
    if (departure.is_change)
      throw Error(
          fmt::format("{}: only the script that made this run can make it again, for it changed the run: {}",
                      run.string(), departure.why));
}

bool is_of(const StageState& state, const fs::path& run) {
  return state.file == stage_checkpoint(run, 0).parent_path() / state.file.filename();
}

/// Opens the state at the end of a stage, from which a run is forked.
/// \param parent  run that is forked, as its folder has it
CheckpointFile open_state(const StageState& state, std::int64_t stage, const fs::path& run,
                          const Setup& parent) {
  if (fs::exists(state.file)) return CheckpointFile(state.file);
  const std::string again =
      fmt::format("a run of the deck from the beginning gives the same: pyroclast run {} --out NEW",
                  shell_path(run / RunFolder::kDeck));
  if (!is_of(state, run))
    throw Error(
        fmt::format("{}: this fork did not compute stage {} itself; the state at its end, {}, is not "
                    "there: the run that holds it was moved or removed. Put it back, or else {}",
                    run.string(), stage, state.file.string(), again));
  if (!parent.checkpoints.keep_stages)
    throw Error(fmt::format("{}: keeps no states of stages ([output] keep_stage_checkpoints = false); {}",
                            run.string(), again));
  throw Error(fmt::format("{}: there is no state of the end of stage {}, {}: the run has not come to it; {}",
                          run.string(), stage, state.file.string(), again));
}

}  // namespace

void require_later(const std::string& change, std::int64_t stage) {
  const std::string key = change.substr(0, change.find('='));
  if (key.starts_with("output.")) return;
  constexpr std::string_view kStages = "stages[";
  if (key.starts_with(kStages)) {
    std::int64_t of = 0;
    const auto [end, error] = std::from_chars(key.data() + kStages.size(), key.data() + key.size(), of);
    if (error == std::errc{} && *end == ']' && of > stage) return;
    throw Error(fmt::format("{}: the parent has done this stage; only stages[{}] and later may change",
                            change, stage + 1));
  }
  if (key.starts_with("coupling"))
    throw Error(
        fmt::format("{}: [coupling] acts in earlier stages too; say stages[{}].{} for that stage alone",
                    change, stage + 1, key));
  throw Error(
      fmt::format("{}: acts before the end of stage {}; in a fork only stages[{}] and later, their coupling "
                  "(stages[{}].coupling.KEY) and output may change",
                  change, stage, stage + 1, stage + 1));
}

void copy_frames(const fs::path& from, const fs::path& to, int count) {
  fs::create_directories(to / "fields");
  for (const MeshPart part : {MeshPart::blocks, MeshPart::contacts})
    for (int i = 0; i < count; ++i)
      if (const auto name = fs::path("fields") / FrameSeries::file_name(part, i); fs::exists(from / name))
        write_text_file(to / name, read_file(from / name));  // on the disk before a checkpoint counts on it
}

/// Returns the newest checkpoint of a run, as the first rank finds it: a collective.
CheckpointFile newest_on_ranks(const fs::path& run, const RunChoices& choices) {
  if (!choices.ranks) return newest_checkpoint(run);
  const std::string found = choices.is_first() ? newest_checkpoint(run).path().string() : "";
  const auto path = choices.ranks->collect(std::vector<char>(found.begin(), found.end()));
  return CheckpointFile(std::string(path.begin(), path.end()));
}

std::unique_ptr<Session> Session::resume(const fs::path& folder, const fs::path& stated,
                                         const RunChoices& choices) {
  RunFolder::require(folder);
  auto lock = choices.is_first() ? std::make_unique<FolderLock>(folder) : nullptr;
  require_deck_alone(folder);
  const CheckpointFile checkpoint =
      stated.empty() ? newest_on_ranks(folder, choices) : CheckpointFile(stated);
  std::unique_ptr<Session> session(new Session(open_from(folder, {}, {}, choices), std::move(lock), folder));
  require_same(checkpoint, session->inputs_.hash(), *session->simulation_);
  session->restore(checkpoint);
  const Run& run = session->run_;
  // where the disk was full at the end, the summary is still to be written
  if (run.outcome() != Outcome::running && choices.is_first() && fs::exists(folder / "summary.json"))
    throw Error(fmt::format(
        "{}: the run is over ({}); to add stages: pyroclast resume {} --stages MORE.toml --out NEW",
        folder.string(), describe(run.outcome()), shell_path(folder)));
  session->last_checkpoint_ = checkpoint.path();
  if (choices.is_first()) RunFolder::remove_drawn(folder);
  session->open(checkpoint.info().number);
  return session;
}

std::unique_ptr<Session> Session::fork(const ForkOf& of, const RunOutput& output, const RunChoices& choices) {
  // the parent is only read: it may still run
  RunFolder::require(of.run);
  require_deck_alone(of.run);
  DeckOfRun parent = open_from(of.run, {}, {}, choices);
  const std::int64_t stage = of.from_stage.empty() ? static_cast<std::int64_t>(parent.setup.stages.size()) - 1
                                                   : stage_of(of.from_stage, parent.setup);
  for (const std::string& change : of.changes) require_later(change, stage);
  const std::vector<StageState> states =
      stage_states(of.run, stage + 1, inputs_of(parent.deck, parent.setup).hash());
  const CheckpointFile checkpoint = open_state(states.back(), stage, of.run, parent.setup);

  const Appendix more = of.more.empty() ? Appendix() : Appendix{read_file(of.more), of.more.string()};
  DeckOfRun opened = open_from(of.run, of.changes, more, choices);
  if (!of.more.empty() && opened.setup.stages.size() == parent.setup.stages.size())
    throw Error(fmt::format("{}: has no [[stages]], so that nothing follows", of.more.string()));
  auto held = choices.is_first() ? lock(output) : nullptr;
  std::unique_ptr<Session> session(new Session(std::move(opened), std::move(held), output.folder));
  if (is_of(states.back(), of.run))
    require_same(checkpoint, states.back().inputs, *session->simulation_);
  else
    require_same(checkpoint, states.back().inputs, *session->simulation_,
                 "another run than the one that was forked: its folder was written anew since then");
  session->restore(checkpoint);
  if (session->run_.outcome() != Outcome::running)
    throw Error(fmt::format("{}: no stage can follow stage {}, which ended the run ({})", of.run.string(),
                            stage, describe(session->run_.outcome())));
  std::vector<std::string> changes = of.changes;
  if (!of.more.empty()) changes.push_back(of.more.string());
  if (choices.is_first()) {
    session->make_folder(output, Parent{of.run, stage, changes, states});
    copy_frames(of.run, output.folder, static_cast<int>(session->writer_.frames().rows.size()));
  }
  session->open(checkpoint.info().number);
  session->checkpoint_is_due_ = true;
  return session;
}

}  // namespace pyroclast
