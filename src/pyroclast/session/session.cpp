#include "pyroclast/session/session.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/base/state_copy.hpp"
#include "pyroclast/results/text_file.hpp"
#include "pyroclast/session/later.hpp"
#include "pyroclast/simulation/body_on_ranks.hpp"
#include "pyroclast/simulation/coupling.hpp"
#include "pyroclast/stages/drive.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

namespace {

std::unique_ptr<Simulation> make_simulation_of(const DeckOfRun& opened,
                                               std::optional<MadeSpecimen> specimen) {
  if (specimen) return make_simulation(opened.setup, *std::move(specimen), opened.team, opened.choices.ranks);
  if (opened.body)
    return make_simulation(opened.setup,
                           opened.body->read(opened.choices.ranks, foreign_blocks(opened.setup.moving)),
                           opened.team, opened.choices.ranks);
  opened.choices.before_making(opened);
  return make_simulation(opened.setup, opened.team, opened.choices.ranks);
}

std::optional<BodyOfRun> body_of(const DeckOfRun& opened) {
  if (!opened.body) return std::nullopt;
  // a resume may begin in another directory
  return BodyOfRun{std::filesystem::absolute(opened.choices.body).lexically_normal(), opened.body->hash()};
}

/// Returns the folder into which this process writes the files of a run; none on ranks but the first.
std::filesystem::path written_folder(const std::filesystem::path& folder, const RunChoices& choices) {
  return choices.is_first() ? folder : std::filesystem::path();
}

/// Returns the inputs. Throws Error where ranks run different programs, decks, files that a deck names or
/// bodies.
Inputs same_on_all_ranks(const DeckOfRun& opened, Inputs inputs) {
  const auto& ranks = opened.choices.ranks;
  if (!ranks) return inputs;
  struct Identity {
    std::array<char, 80> program{}, inputs{}, body{};
  };
  Identity own;
  fmt::format_to_n(own.program.data(), own.program.size() - 1, "{} {}", kVersion, kCommit);
  inputs.hash().copy(own.inputs.data(), own.inputs.size() - 1);
  if (opened.body) opened.body->hash().copy(own.body.data(), own.body.size() - 1);
  const auto all = ranks->collect(std::vector{own});
  for (std::size_t rank = 1; rank < all.size(); ++rank) {
    if (all[rank].program != all[0].program)
      throw Error(fmt::format("rank {} runs pyroclast {}, but rank 0 {}: start one program on all ranks",
                              rank, all[rank].program.data(), all[0].program.data()));
    if (all[rank].inputs != all[0].inputs)
      throw Error(fmt::format(
          "rank {} reads another deck than rank 0, or other files that a deck names: all ranks need the same",
          rank));
    if (all[rank].body != all[0].body)
      throw Error(fmt::format("rank {} reads another body than rank 0: all ranks need the same", rank));
  }
  return inputs;
}

/// Error of a file that could not be written: nothing is wrong with the run.
struct NotWritten : Error {
  using Error::Error;
};

std::string key_of(const std::string& change) {
  return change.substr(0, change.find('='));
}

/// Returns a text in one line.
std::string told(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// Throws Error where materials differ in what a run takes only at its beginning.
void require_same_body(const ConcreteMaterials& old, const ConcreteMaterials& changed) {
  for (std::size_t i = 0; i < old.block_materials.size(); ++i)
    if (old.block_materials[i].density(kReferenceTemperature) !=
        changed.block_materials[i].density(kReferenceTemperature))
      throw Error("a density cannot change in a run: mass would come or go");
  for (std::size_t i = 0; i < old.contacts.size(); ++i)
    if (old.contacts[i].law != changed.contacts[i].law)
      throw Error(
          "a contact law cannot change in a run: contacts keep the internal variables of the old law");
  if (old.on_cooling != changed.on_cooling)
    throw Error(
        "materials.on_cooling cannot change in a run, which keeps its highest temperatures from the start");
  if (old.creeps() != changed.creeps())
    throw Error(
        "whether phases creep cannot change in a run: [materials.NAME.creep] is there from the start");
  if (!old.asks_for_hottest() && changed.asks_for_hottest())
    throw Error(
        "materials.NAME.contraction cannot come into a run with materials.on_cooling = \"reversible\": the "
        "highest temperature is kept only where a deck asks for it from the start");
}

}  // namespace

/// Returns the result of `act`, which writes. An Error of `act` then tells from where the run can go on.
template <class Act>
auto Session::telling_where_to_go_on(Act act) {
  try {
    return act();
  } catch (const Error& error) {
    if (last_checkpoint_.empty()) throw;
    throw NotWritten(
        fmt::format("{}\nthe run is broken off; to go on from {}, its last checkpoint: pyroclast resume {}",
                    error.what(), last_checkpoint_.string(), shell_path(shared_folder_)));
  }
}

Session::Session(DeckOfRun opened, std::unique_ptr<FolderLock> lock, std::filesystem::path folder,
                 std::optional<MadeSpecimen> specimen)
    : lock_(std::move(lock)),
      folder_(written_folder(folder, opened.choices)),
      shared_folder_(std::move(folder)),
      opened_(std::move(opened)),
      inputs_(same_on_all_ranks(opened_, inputs_of(opened_.deck, opened_.setup))),
      simulation_(make_simulation_of(opened_, std::move(specimen))),
      writer_(folder_, opened_.setup),
      run_(*simulation_, std::move(opened_.setup.stages)) {
  run_.ask([this] {
    const bool is_due =
        checkpoints_ && opened_.choices.is_first() && (checkpoint_is_due_ || checkpoints_->is_due());
    return Wishes{.stop = stop_asked_(), .save = is_due};
  });
  run_.between_batches([this](Run& run, const Wishes& wishes) {
    if (checkpoints_ && (wishes.stop || wishes.save)) {
      checkpoint_is_due_ = false;
      telling_where_to_go_on([&] {
        checkpoints_->write(run);
        last_checkpoint_ = checkpoints_->last();
      });
    }
    between_batches_();
  });
}

/// Locks the folder of an output. Throws Error where the folder may not be written.
std::unique_ptr<FolderLock> Session::lock(const RunOutput& output) {
  auto held = std::make_unique<FolderLock>(output.folder);
  RunFolder::check(output.folder, output.overwrite, output.remedy);
  return held;
}

std::unique_ptr<Session> Session::begin(DeckOfRun opened, const std::optional<RunOutput>& output) {
  const bool writes = output && opened.choices.is_first();
  auto held = writes ? lock(*output) : nullptr;
  std::unique_ptr<Session> session(
      new Session(std::move(opened), std::move(held), output ? output->folder : std::filesystem::path()));
  if (writes) session->make_folder(*output, std::nullopt);
  if (output) session->open(0);
  return session;
}

void Session::make_folder(const RunOutput& output, std::optional<Parent> parent) {
  const RunFolder made(
      folder_, output.overwrite,
      {opened_.deck.name(), inputs_, opened_.setup.specimen.seed, opened_.team->size(),
       name(opened_.instructions), output.command, own_laws(), std::move(parent), body_of(opened_)});
  foreign_ = made.foreign();
  for (const Departure& departure : departures_) RunFolder::note_departure(folder_, departure);
}

/// \param last_checkpoint  number of the checkpoint that the run goes on from; 0 where it begins
void Session::open(std::int64_t last_checkpoint) {
  has_files_ = true;
  checkpoints_.emplace(
      shared_folder_, opened_.setup.checkpoints,
      Checkpoints::Sources{inputs_.hash(), body_hash(*simulation_),
                           [this](StateVisitor& visitor) { visit_state(visitor); },
                           [this] { return writer_.wall_time(); }, [this] { return log_bytes_(); }},
      last_checkpoint);
  writer_.begin(run_);
}

void Session::visit_state(StateVisitor& visitor) {
  run_.visit_state(visitor);
  writer_.visit_state(visitor, run_.history().row_count());
}

void Session::restore(const CheckpointFile& checkpoint) {
  checkpoint.restore([this](StateVisitor& visitor) { visit_state(visitor); });
  goes_on_from_ = checkpoint.info();
}

void Session::stop_when(const std::function<bool()>& asked) {
  stop_asked_ = asked;
}

bool Session::next() {
  run_.go_on();
  try {
    if (!run_.next()) return false;
  } catch (const NotWritten&) {
    throw;
  } catch (const Error& error) {
    if (last_checkpoint_.empty()) throw;
    throw Error(
        fmt::format("{}\nthe run is broken off, and would be there again if it were resumed: change the deck "
                    "and run it anew",
                    error.what()));
  }
  if (!has_files_) return true;
  return telling_where_to_go_on([&] {
    writer_.write(run_);
    if (checkpoints_ && run_.stage_is_over()) {
      checkpoints_->end_stage(run_);
      last_checkpoint_ = checkpoints_->last();
    }
    return true;
  });
}

Summary Session::finish() {
  return telling_where_to_go_on([&] { return has_files_ ? writer_.finish(run_) : writer_.summary(run_); });
}

std::unique_ptr<Session> Session::copy(const std::vector<std::string>& changes,
                                       const std::optional<RunOutput>& output) {
  for (const std::string& change : changes) require_later(change, run_.last_begun_stage());
  auto held = output ? lock(*output) : nullptr;
  DeckOfRun opened(Deck::parse(opened_.deck.text(), opened_.deck.name(), changes), opened_.folder,
                   opened_.choices);
  opened.team->resize(opened_.team->size());
  std::unique_ptr<Session> copied(new Session(std::move(opened), std::move(held),
                                              output ? output->folder : std::filesystem::path(),
                                              simulation_->specimen()));
  StateCopy state;
  state.take([this](StateVisitor& visitor) { visit_state(visitor); });
  state.put([&](StateVisitor& visitor) { copied->visit_state(visitor); });
  for (const Departure& departure : departures_) copied->depart(departure);
  if (!output) return copied;
  std::optional<Parent> parent;
  if (!folder_.empty()) {
    const std::int64_t begun = run_.last_begun_stage();
    const std::int64_t over = run_.stage_is_under_way() ? begun : begun + 1;
    parent = {folder_, begun, changes, stage_states(folder_, over, inputs_.hash())};
  }
  copied->make_folder(*output, std::move(parent));
  if (!folder_.empty())
    copy_frames(folder_, copied->folder_, static_cast<int>(copied->writer_.frames().rows.size()));
  copied->open(0);
  return copied;
}

void Session::leave_folder() {
  has_files_ = false;
  checkpoints_.reset();
  lock_.reset();
}

void Session::write_checkpoint() {
  if (!checkpoints_) throw Error("this run has no folder, so a checkpoint has no place: say out=");
  checkpoints_->write(run_);
  last_checkpoint_ = checkpoints_->last();
}

Setup Session::read(const Deck& deck) const {
  Setup setup = read_setup(deck, opened_.folder, opened_.choices.kinds, opened_.choices.laws);
  setup.specimen.seed = opened_.setup.specimen.seed;
  setup.checkpoints = opened_.setup.checkpoints;
  return setup;
}

/// Takes over a changed deck for all that is to come; the folder of the run follows it.
void Session::take_over(Deck deck, Setup setup) {
  opened_.deck = std::move(deck);
  opened_.setup = std::move(setup);
  if (!checkpoints_) return;
  inputs_ = inputs_of(opened_.deck, opened_.setup);
  checkpoints_->set_inputs(inputs_.hash());
  RunFolder::replace_inputs(folder_, inputs_);
  writer_.begin(run_);
}

void Session::change_stages(const std::vector<std::string>& changes, const std::string& more) {
  for (const std::string& change : changes) require_later(change, run_.last_begun_stage());
  Deck deck = Deck::parse(opened_.deck.text(), opened_.deck.name(), changes, {more, "the appended stages"});
  Setup setup = read(deck);
  run_.change_later_stages(std::move(setup.stages));
  take_over(std::move(deck), std::move(setup));
}

void Session::change_materials(const std::vector<std::string>& changes) {
  for (const std::string& change : changes)
    if (!change.starts_with("materials.") && !change.starts_with("contacts."))
      throw Error(fmt::format("{}: in a run only keys of [materials], [contacts] and later stages change",
                              key_of(change)));
  if (!simulation_->moves()) throw Error("nothing moves in this run, so its materials have no properties");
  Deck deck = Deck::parse(opened_.deck.text(), opened_.deck.name(), changes);
  Setup setup = read(deck);
  auto materials = make_materials(setup.block_materials, *setup.moving, simulation_->numbers());
  require_same_body(simulation_->materials(), materials);
  simulation_->set_materials(std::move(materials));
  take_over(std::move(deck), std::move(setup));
  for (const std::string& change : changes)
    depart({fmt::format("{} from step {} on", change, simulation_->motion().steps())});
}

void Session::drive(const std::string& drives) {
  if (!simulation_->moves()) throw Error("nothing moves in this run, so there is nothing to hold or load");
  if (run_.history().row_count() == 0) throw Error("the run has not begun: go on to its first sample");
  Deck deck = Deck::parse("duration = \"1 s\"\n" + drives, "drive");
  StageTables tables;
  tables.folder = opened_.folder;
  tables.dimension = simulation_->model().dimension();
  const auto stage = drive_kind().read(deck.root(), tables);
  deck.finish();
  const auto& drive = dynamic_cast<const Drive&>(*stage);
  Acting acting = acting_on(*simulation_);
  drive.check(*simulation_, acting);
  if (run_.stage_is_under_way()) {
    if (const auto* under_way = dynamic_cast<const Drive*>(&run_.stage()))
      drive.check_beside(*under_way, *simulation_, acting.supports);
    const auto load = [](const auto& one) { return one->loads(); };
    if (has_weight(*simulation_) || drive.loads() || std::ranges::any_of(run_.stages(), load))
      require_held(*simulation_, acting.supports, "drive");
  }
  run_.check_later_stages(acting);
  stage->begin(*simulation_);
  stage->advance(*simulation_, 0);
  depart({fmt::format("{} from step {} on", told(drives), simulation_->motion().steps())});
}

void Session::end_stage() {
  run_.end_stage();
  depart({fmt::format("stage {} was ended at row {}", run_.stage_number(), run_.history().row_count() - 1)});
}

void Session::set_temperature(double temperature) {
  simulation_->field().set_uniform(temperature);
  if (simulation_->moves()) simulation_->hand_over();
  depart({fmt::format("the temperature was set to {:g} degC at row {}", temperature,
                      run_.history().row_count() - 1)});
}

void Session::depart(const Departure& departure) {
  if (std::ranges::find(departures_, departure) != departures_.end()) return;
  departures_.push_back(departure);
  writer_.warn("not reproducible from the deck: " + departure.why);
  if (checkpoints_) RunFolder::note_departure(folder_, departure);
}

}  // namespace pyroclast
