#include <algorithm>
#include <charconv>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pyroclast/app/drive.hpp"
#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/read_file.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast::app {

namespace {

namespace fs = std::filesystem;

constexpr const char* kDeck = "deck.toml";

/// Throws Error where a checkpoint is not one of this program, these inputs and this body.
void require_same(const CheckpointFile& checkpoint, const std::string& inputs, const Simulation& simulation) {
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
  if (info.inputs != inputs)
    refuse("belongs to other inputs: deck.toml or a file of inputs/ was changed since the run began");
  if (info.body != body_hash(simulation))
    refuse("belongs to another body: specimen or laws of this program differ from those that the run had");
}

RunOptions own_options(const ResumeOptions& options) {
  RunOptions own = options.as;
  own.deck = options.run / kDeck;
  own.out = options.run;
  own.changes.clear();
  return own;
}

int go_on(const ResumeOptions& options) {
  const RunOptions own = own_options(options);
  const FolderLock lock(options.run);
  const CheckpointFile checkpoint =
      options.checkpoint.empty() ? newest_checkpoint(options.run) : CheckpointFile(options.checkpoint);
  Loaded loaded(own);
  const Inputs inputs = inputs_of(loaded.deck, loaded.setup);
  const auto simulation = make_simulation_aloud(loaded, options.as.speech);
  require_same(checkpoint, inputs.hash(), *simulation);

  Recorder recorder(options.run, loaded.setup);
  Run run(*simulation, std::move(loaded.setup.stages));
  checkpoint.restore(state_of(run, recorder));
  // where the disk was full at the end, the summary is still to be written
  if (run.outcome() != Outcome::running && fs::exists(options.run / "summary.json"))
    throw Error(fmt::format(
        "{}: the run is over ({}); to add stages: pyroclast resume {} --stages MORE.toml --out NEW",
        options.run.string(), describe(run.outcome()), options.run.string()));
  RunLog log(options.run / "run.log", options.as.speech, checkpoint.info().log_bytes);
  log.say_now(fmt::format("goes on from {}, step {}, stage {} of {}", checkpoint.path().filename().string(),
                          checkpoint.info().step, run.stage_number() + 1, run.stages().size()));
  if (checkpoint.info().commit != kCommit)
    log.say(fmt::format("                it was written by another build, of commit {}",
                        checkpoint.info().commit));
  Checkpoints checkpoints(options.run, loaded.setup.checkpoints,
                          checkpoint_sources(run, recorder, log, inputs.hash()), checkpoint.info().number);
  recorder.begin(run);
  return drive(run, recorder, checkpoints, log, options.run, own);
}

/// The stage with this number or name.
std::int64_t stage_of(const std::string& stated, const Setup& setup) {
  std::int64_t number = 0;
  const auto count = static_cast<std::int64_t>(setup.stages.size());
  const auto [end, error] = std::from_chars(stated.data(), stated.data() + stated.size(), number);
  if (error == std::errc{} && end == stated.data() + stated.size()) {
    if (number >= 0 && number < count) return number;
    throw Error(fmt::format("--from-stage {}: the run has stages 0 to {}", stated, count - 1));
  }
  const auto& names = setup.stage_names;
  const auto found = std::ranges::count(names, stated);
  if (found == 1) return std::ranges::find(names, stated) - names.begin();
  throw Error(fmt::format("--from-stage {}: {} of the stages have this name; they are, from 0 on: {}", stated,
                          found, fmt::join(names, ", ")));
}

/// Throws Error where a change would act before the end of a stage.
void require_later(const std::string& change, std::int64_t stage) {
  const std::string key = change.substr(0, change.find('='));
  if (key.starts_with("output.")) return;
  constexpr std::string_view kStages = "stages[";
  if (key.starts_with(kStages)) {
    std::int64_t of = 0;
    const auto [end, error] = std::from_chars(key.data() + kStages.size(), key.data() + key.size(), of);
    if (error == std::errc{} && *end == ']' && of > stage) return;
    throw Error(
        fmt::format("--set {}: this stage is done in what is forked; only stages[{}] and later may change",
                    change, stage + 1));
  }
  if (key.starts_with("coupling"))
    throw Error(
        fmt::format("--set {}: [coupling] acts in earlier stages too; say stages[{}].{} for that stage alone",
                    change, stage + 1, key));
  throw Error(fmt::format(
      "--set {}: acts before the end of stage {}; in a fork only stages[{}] and later, their coupling "
      "(stages[{}].coupling.KEY) and output may change",
      change, stage, stage + 1, stage + 1));
}

/// Frames that both runs have in common.
void copy_frames(const fs::path& from, const fs::path& to, int count) {
  fs::create_directories(to / "fields");
  for (const MeshPart part : {MeshPart::blocks, MeshPart::contacts})
    for (int i = 0; i < count; ++i)
      if (const auto name = fs::path("fields") / FrameSeries::file_name(part, i); fs::exists(from / name))
        fs::copy_file(from / name, to / name);
}

int fork(const ResumeOptions& options) {
  // the parent is only read: it may still run
  RunOptions of_parent = own_options(options);
  Loaded parent(of_parent);
  const std::int64_t stage = options.more.empty() ? stage_of(options.from_stage, parent.setup)
                                                  : static_cast<std::int64_t>(parent.setup.stages.size()) - 1;
  for (const std::string& change : options.as.changes) require_later(change, stage);
  const CheckpointFile checkpoint(stage_checkpoint(options.run, stage));

  RunOptions own = options.as;
  own.deck = options.run / kDeck;
  const std::string more = options.more.empty() ? "" : read_file(options.more);
  Loaded loaded(own, more);
  const FolderLock lock(own.out);
  RunFolder::check(own.out, own.overwrite);
  const Inputs inputs = inputs_of(loaded.deck, loaded.setup);
  const auto simulation = make_simulation_aloud(loaded, own.speech);
  require_same(checkpoint, inputs_of(parent.deck, parent.setup).hash(), *simulation);

  Recorder recorder(own.out, loaded.setup);
  Run run(*simulation, std::move(loaded.setup.stages));
  checkpoint.restore(state_of(run, recorder));
  if (run.outcome() != Outcome::running)
    throw Error(fmt::format("{}: no stage can follow stage {}, which ended the run ({})",
                            options.run.string(), stage, describe(run.outcome())));
  std::vector<std::string> changes = own.changes;
  if (!more.empty()) changes.push_back(options.more.string());
  make_run_folder(loaded, own, inputs, Parent{options.run, stage, changes});
  copy_frames(options.run, own.out, static_cast<int>(recorder.frames().rows.size()));
  RunLog log(own.out / "run.log", own.speech);
  log.say(fmt::format("fork            of {}, from the end of stage {}", options.run.string(), stage));
  log.say(describe_start(*simulation, loaded));
  Checkpoints checkpoints(own.out, loaded.setup.checkpoints,
                          checkpoint_sources(run, recorder, log, inputs.hash()), checkpoint.info().number);
  recorder.begin(run);
  checkpoints.between_batches(run, true);
  return drive(run, recorder, checkpoints, log, own.out, own);
}

}  // namespace

int resume(const ResumeOptions& options) {
  RunFolder::require(options.run);
  const bool forks = !options.from_stage.empty() || !options.more.empty();
  if (forks && options.as.out.empty()) throw Error("a fork needs a folder of its own: --out NEW");
  if (!forks && !options.as.changes.empty())
    throw Error(
        "--set: a run that goes on stays what it is; to change something, fork it: --from-stage K --out NEW");
  if (!forks && !options.as.out.empty())
    throw Error("--out: a run goes on in its own folder; a fork needs --from-stage or --stages");
  return forks ? fork(options) : go_on(options);
}

}  // namespace pyroclast::app
