#include <array>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>
#include <xxhash.h>

#include "pyroclast/results/checkpoint_file.hpp"
#include "stages/drives.hpp"
#include "stages/small_runs.hpp"
#include "targets.hpp"

namespace pyroclast::fuzz {

namespace {

/// A run that goes on from an edited state may take very long; so many batches of it tell enough.
constexpr int kBatches = 4;
constexpr int kStepsOfABatch = 10;

struct Kept {
  std::size_t item = 0, count = 0;
  std::vector<std::byte> bytes;
};

/// Takes a state apart, and shows what became of it as a file does.
class Rows : public StateVisitor {
 public:
  bool replaces() const override { return shows; }
  bool checks() const override { return shows; }

  bool shows = false;
  std::map<std::string, Kept> all;

 protected:
  void visit_piece(const std::string& name, const Piece& piece) override {
    if (!shows) {
      all[name] = {piece.item, piece.count, {piece.data, piece.data + piece.item * piece.count}};
      return;
    }
    const auto found = all.find(name);
    if (found == all.end()) throw Error("does not hold " + name);
    const Kept& kept = found->second;
    if (kept.item != piece.item || (!piece.resize && kept.count != piece.count))
      throw Error("another size of " + name);
    std::byte* to = piece.resize ? piece.resize(kept.count) : piece.data;
    if (!kept.bytes.empty()) std::memcpy(to, kept.bytes.data(), kept.bytes.size());
  }
};

/// A run and its state on the way.
struct Base {
  std::string deck;
  std::map<std::string, Kept> state;
};

Base made_base(std::string deck, std::size_t looks) {
  Trial trial(deck);
  while (trial.run.history().row_count() < looks && trial.run.next()) continue;
  Rows rows;
  trial.run.visit_state(rows);
  return {std::move(deck), std::move(rows.all)};
}

constexpr std::size_t kBases = 3;

/// Of a test with cracks, of heat with exchanges, and of drives with a control. Each is made when it is asked
/// for.
Base base_of(std::size_t number) {
  const std::string settle = "[[stages]]\nkind = \"settle\"\nunbalanced_ratio = 0.1\nmost_steps = 100000\n";
  const auto small = [](const std::string& text) { return with(text, "count = 60", "count = 30"); };
  if (number == 0) {
    const std::string fast = with(kFailure, "velocity = \"1 mm/s\"", "velocity = \"20 mm/s\"");
    return made_base(small(pyroclast::deck(kUniform + settle + fast)), 150);
  }
  if (number == 1) return made_base(small(pyroclast::deck(kHeatedFace + settle + kExpose)), 8);
  const std::string sets =
      "[[sets]]\nname = \"one\"\nbox = [[\"10 mm\", \"0 mm\"], [\"20 mm\", \"120 mm\"]]\n"
      "[[sets]]\nname = \"other\"\nbox = [[\"40 mm\", \"0 mm\"], [\"50 mm\", \"120 mm\"]]\n"
      "[[sets]]\nname = \"corner\"\nwithin = \"left\"\nnearest = [\"0 mm\", \"0 mm\"]\n" +
      pyroclast::record("middle", "opening", "set = \"one\"\nother = \"other\"\ndirection = \"x\"") +
      pyroclast::record("grip", "force", "set = \"left\"\ndirection = \"x\"");
  const std::string controlled = drive(
      "duration = \"20 ms\"\n[stages.control]\nrecord = \"middle\"\nrate = \"1 mm/s\"\n"
      "stiffness = \"2 GN/m\"\nresponse_time = \"2 ms\"",
      does("left", "hold = [\"x\"]") + does("corner", "hold = [\"y\"]") +
          does("right", "force = \"60 kN\"\ndirection = [1, 0]") +
          "[[stages.until]]\nrecord = \"grip\"\nshare_of_peak = 0.5\n");
  return made_base(small(free_deck(kUniform + sets + controlled)), 40);
}

const Base& known_base(std::size_t number) {
  static std::map<std::size_t, Base> made;
  const auto found = made.find(number);
  return found != made.end() ? found->second : made.emplace(number, base_of(number)).first->second;
}

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find(at, begin), text.size());
    if (end > begin) parts.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return parts;
}

template <class T>
bool number(std::string_view text, T& value) {
  return std::from_chars(text.data(), text.data() + text.size(), value).ec == std::errc{};
}

template <class T>
void put(Kept& piece, std::uint64_t place, std::string_view text) {
  T value{};
  if (piece.bytes.size() < sizeof(T) || !number(text, value)) return;
  std::memcpy(piece.bytes.data() + place % (piece.bytes.size() / sizeof(T)) * sizeof(T), &value, sizeof(T));
}

/// "PIECE PLACE KIND VALUE". Piece: its name or its number; kind: double, long, int, byte, or count, of the
/// piece.
void edit(std::map<std::string, Kept>& state, std::string_view line) {
  const auto words = split(line, ' ');
  std::uint64_t piece = 0, place = 0;
  if (words.size() != 4 || !number(words[1], place)) return;
  auto at = state.find(std::string(words[0]));
  if (at == state.end()) {
    if (!number(words[0], piece)) return;
    at = std::next(state.begin(), static_cast<std::ptrdiff_t>(piece % state.size()));
  }
  Kept& kept = at->second;
  if (words[2] == "double") put<double>(kept, place, words[3]);
  if (words[2] == "long") put<std::int64_t>(kept, place, words[3]);
  if (words[2] == "int") put<std::int32_t>(kept, place, words[3]);
  if (words[2] == "byte") put<std::uint8_t>(kept, place, words[3]);
  if (std::uint16_t count = 0; words[2] == "count" && number(words[3], count)) {
    kept.count = count;
    kept.bytes.resize(kept.item * count);
  }
}

void go_on(const Base& base, std::vector<std::string_view> edits) {
  Rows rows;
  rows.all = base.state;
  for (const std::string_view line : edits) edit(rows.all, line);
  rows.shows = true;
  Trial trial(base.deck);
  trial.run.visit_state(rows);
  int batches = 0;
  cut_batches(trial.run, kStepsOfABatch);
  trial.run.between_batches([](Run&, const Wishes&) {});
  trial.run.stop_when([&] { return ++batches > kBatches; });
  while (trial.run.next()) continue;
  for (std::size_t i = 0; i < trial.run.courses().size(); ++i) {
    const StageCourse& record = trial.run.courses()[i];
    if (record.outcome != Outcome::not_begun)
      trial.run.stages()[i]->report(trial.run.history(), record.rows, record.outcome);
  }
}

/// A file with this table, whose hash is right.
void read_table(std::string_view table) {
  namespace fs = std::filesystem;
  const fs::path path = fs::temp_directory_path() / ("fuzz-" + std::to_string(getpid()) + ".state");
  struct Remove {
    const fs::path& path;
    ~Remove() {
      std::error_code ignored;
      fs::remove(path, ignored);
    }
  } const at_the_end{path};
  const std::string rows = std::string("pyroclas") + std::string(64, '\1');
  const std::array<std::uint64_t, 3> trailer{rows.size(), table.size(),
                                             XXH3_64bits(table.data(), table.size())};
  {
    std::ofstream file(path, std::ios::binary);
    file << rows << table;
    file.write(reinterpret_cast<const char*>(trailer.data()), sizeof(trailer));
    file << "t-state2";
  }
  const CheckpointFile file(path);
  require(file.info().number >= 0 && file.info().step >= 0, "what is counted is not negative");
  file.verify();
}

}  // namespace

bool checkpoint(std::string_view text) {
  return takes([&] {
    if (text.starts_with("{")) {
      read_table(text);
      return;
    }
    auto lines = split(text, '\n');
    std::size_t base = 0;
    if (!lines.empty() && number(lines.front(), base)) lines.erase(lines.begin());
    go_on(known_base(base % kBases), std::move(lines));
  });
}

}  // namespace pyroclast::fuzz
