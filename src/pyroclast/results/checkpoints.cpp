#include "pyroclast/results/checkpoints.hpp"

#include <algorithm>
#include <charconv>
#include <memory>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <xxhash.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/base/physics_version.hpp"
#include "pyroclast/base/shell_words.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".state";
/// Number of checkpoints that are kept beside those of stages.
constexpr std::size_t kKept = 2;
/// Least wait for the next checkpoint, over the time that it took to write the last.
constexpr double kLeastRest = 100.0;

/// Hash (XXH3) of the numbers of lists.
class Hash {
 public:
  Hash() { XXH3_128bits_reset(state_.get()); }

  template <class T>
  void add(const std::vector<T>& list) {
    const std::uint64_t count = list.size();
    XXH3_128bits_update(state_.get(), &count, sizeof(count));
    XXH3_128bits_update(state_.get(), list.data(), list.size() * sizeof(T));
  }
  void add(const std::string& text) { add(std::vector<char>(text.begin(), text.end())); }

  std::uint64_t low() const { return XXH3_128bits_digest(state_.get()).low64; }
  std::string text() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_{XXH3_createState()};
};

bool is_stage_checkpoint(const fs::path& path) {
  return path.filename().string().starts_with("stage_");
}

/// Tells whether a file that does not tell its number may have been written after a checkpoint, by its name.
bool may_be_newer(const fs::path& file, const CheckpointInfo& than) {
  const std::string stem = file.stem().string();
  std::int64_t number = 0;
  if (is_stage_checkpoint(file)) {
    const auto digits = stem.substr(stem.find('_') + 1);
    if (std::from_chars(digits.data(), digits.data() + digits.size(), number).ec != std::errc{}) return true;
    return number > than.stage || (number == than.stage && !than.stage_is_over);
  }
  if (std::from_chars(stem.data(), stem.data() + stem.size(), number).ec != std::errc{}) return true;
  return number > than.number;
}

std::vector<fs::path> files_of(const fs::path& run_folder) {
  std::vector<fs::path> files;
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(checkpoint_folder(run_folder), none))
    if (entry.path().extension() == kEnding) files.push_back(entry.path());
  return files;
}

}  // namespace

std::string body_hash(const Simulation& simulation) {
  const Model& model = simulation.model();
  const auto* const part = model.part.get();
  // numbers of the whole, so that no hash depends on the parts
  const auto gridpoint = [&](int g) { return part ? part->gridpoint[g] : g; };
  const ContactsByChunk contacts = contacts_by_chunk(model);
  const ChunkList blocks = model.chunks();
  std::vector<std::uint64_t> of_chunks;
  for (int chunk = 0; chunk < blocks.count(); ++chunk) {
    if (blocks.is_foreign(chunk)) continue;
    Hash hash;
    std::vector<int> integers;
    std::vector<double> numbers;
    for (int b = blocks[chunk]; b < blocks[chunk + 1]; ++b) {
      integers.insert(integers.end(),
                      {model.block_material[b], model.block_zones[b + 1] - model.block_zones[b]});
      for (int g = model.block_gridpoints[b]; g < model.block_gridpoints[b + 1]; ++g) {
        const Vec<3> place = model.place(g);
        numbers.insert(numbers.end(), place.c.begin(), place.c.end());
      }
      for (int z = model.block_zones[b]; z < model.block_zones[b + 1]; ++z)
        for (const int g : model.gridpoints_of_zone(z)) integers.push_back(gridpoint(g));
    }
    with_dimension(model, [&](const auto& of_dimension) {
      for (int i = contacts.chunks[chunk]; i < contacts.chunks[chunk + 1]; ++i) {
        const auto& c = of_dimension.contacts[contacts.contacts[i]];
        integers.insert(integers.end(), {gridpoint(c.a), gridpoint(c.b), c.interface});
        numbers.push_back(c.area);
        numbers.insert(numbers.end(), c.normal.c.begin(), c.normal.c.end());
        for (const auto& t : c.tangents) numbers.insert(numbers.end(), t.c.begin(), t.c.end());
      }
    });
    hash.add(integers);
    hash.add(numbers);
    of_chunks.push_back(hash.low());
  }
  Hash hash;
  hash.add(model.ranks().collect(of_chunks));
  for (const auto& name : model.interface_names) hash.add(name);
  if (simulation.moves())
    for (const LawTable* law : simulation.motion().laws()) {
      hash.add(std::string(law->name));
      for (const InternalInfo& number : law->internals(model.dimension())) hash.add(std::string(number.name));
      for (const LossInfo& loss : law->losses) hash.add(std::string(loss.name));
    }
  return hash.text();
}

fs::path checkpoint_folder(const fs::path& run_folder) {
  return run_folder / "checkpoints";
}

fs::path stage_checkpoint(const fs::path& run_folder, std::int64_t stage) {
  return checkpoint_folder(run_folder) / fmt::format("stage_{}{}", stage, kEnding);
}

std::vector<StageState> stage_states(const fs::path& run_folder, std::int64_t count,
                                     const std::string& inputs) {
  std::vector<StageState> states = RunFolder::inherited_states(run_folder);
  if (std::cmp_greater(states.size(), count)) states.resize(static_cast<std::size_t>(count));
  for (auto stage = static_cast<std::int64_t>(states.size()); stage < count; ++stage)
    states.push_back({stage_checkpoint(run_folder, stage), inputs});
  return states;
}

CheckpointFile newest_checkpoint(const fs::path& run_folder) {
  std::vector<CheckpointFile> files;
  std::vector<std::pair<fs::path, std::string>> damaged;
  for (const fs::path& file : files_of(run_folder)) {
    try {
      files.emplace_back(file);
    } catch (const Error& error) {
      damaged.emplace_back(file, error.what());
    }
  }
  std::ranges::sort(files, std::greater<>(), [](const CheckpointFile& c) { return c.info().number; });
  for (const CheckpointFile& newest : files) {
    try {
      newest.verify();
    } catch (const Error& error) {
      damaged.emplace_back(newest.path(), error.what());
      continue;
    }
    for (const auto& [file, what] : damaged)
      if (may_be_newer(file, newest.info()))
        throw Error(
            fmt::format("{}; to go on from the checkpoint before it, of step {}, say --checkpoint-file {}",
                        what, newest.info().step, shell_path(newest.path())));
    return newest;
  }
  throw Error(
      damaged.empty()
          ? fmt::format("{}: holds no checkpoint, so there is nothing to go on from; run its deck again",
                        run_folder.string())
          : fmt::format("{}; no other checkpoint of {} can be read", damaged.front().second,
                        run_folder.string()));
}

Checkpoints::Checkpoints(fs::path run_folder, const CheckpointChoice& choice, Sources sources,
                         std::int64_t last)
    : run_folder_(std::move(run_folder)), choice_(choice), sources_(std::move(sources)), number_(last) {
  written_ = Clock::now();
}

bool Checkpoints::is_due() const {
  if (last_.empty() && number_ == 0) return true;
  if (choice_.interval == 0.0) return true;
  const double age = seconds_since(written_);
  return age >= std::max(choice_.interval, kLeastRest * took_);
}

fs::path Checkpoints::next_file() const {
  return checkpoint_folder(run_folder_) / fmt::format("{:06}{}", number_ + 1, kEnding);
}

void Checkpoints::end_stage(const Run& run) {
  write(run, choice_.keep_stages ? stage_checkpoint(run_folder_, run.stage_number()) : next_file());
}

void Checkpoints::write(const Run& run, const fs::path& path) {
  const auto begin = Clock::now();
  CheckpointInfo info;
  info.number = number_ + 1;
  info.version = kVersion;
  info.commit = kCommit;
  info.physics_version = kPhysicsVersion;
  info.inputs = sources_.inputs;
  info.body = sources_.body;
  info.blocks_of_a_chunk = blocks_of_a_chunk(run.simulation().model().dimension());
  for (const auto& stage : run.stages()) info.stage_kinds.emplace_back(stage->kind());
  info.stage = run.stage_number();
  info.stage_is_over = run.stage_is_over();
  info.step = run.simulation().moves() ? run.simulation().motion().steps() : 0;
  info.wall_time = sources_.wall_time();
  info.log_bytes = sources_.log_bytes();
  Ranks& ranks = run.simulation().ranks();
  if (ranks.is_first()) fs::create_directories(path.parent_path());
  write_checkpoint(path, info, sources_.visit, ranks);
  number_ = info.number;
  last_ = path;
  if (ranks.is_first()) remove_old();
  written_ = Clock::now();
  took_ = std::chrono::duration<double>(written_ - begin).count();
}

void Checkpoints::remove_old() const {
  auto files = files_of(run_folder_);
  std::erase_if(files, is_stage_checkpoint);
  std::ranges::sort(files, std::greater<>());
  std::error_code ignored;
  for (std::size_t i = kKept; i < files.size(); ++i) fs::remove(files[i], ignored);
}

}  // namespace pyroclast
