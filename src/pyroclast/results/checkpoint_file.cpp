#include "pyroclast/results/checkpoint_file.hpp"

#include <algorithm>
#include <array>
#include <exception>
#include <limits>
#include <new>
#include <optional>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <xxhash.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/closing_table.hpp"
#include "pyroclast/results/publish.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

namespace {

using Json = nlohmann::json;

constexpr std::array<char, 8> kBegin{'p', 'y', 'r', 'o', 'c', 'l', 'a', 's'};
constexpr ClosingTable::Mark kEnd{'t', '-', 's', 't', 'a', 't', 'e', '2'};
constexpr ClosingTable::Mark kEndOfOldForm{'t', '-', 's', 't', 'a', 't', 'e', '1'};

/// Reads an entry of a table. Throws Json::exception where the entry is of another kind.
void read_entry(const Json& json, std::string& value) {
  json.get_to(value);
}
void read_entry(const Json& json, std::vector<std::string>& value) {
  json.get_to(value);
}
void read_entry(const Json& json, bool& value) {
  value = json.get_ref<const Json::boolean_t&>();
}
void read_entry(const Json& json, double& value) {
  value = json.get_ref<const Json::number_float_t&>();
}
/// Reads a whole number, which is never negative in a table.
template <class Whole>
void read_entry(const Json& json, Whole& value) {
  const std::uint64_t number = json.get_ref<const Json::number_unsigned_t&>();
  if (number > static_cast<std::uint64_t>(std::numeric_limits<Whole>::max()))
    throw Json::out_of_range::create(401, "a number of the table is too large", nullptr);
  value = static_cast<Whole>(number);
}

class CheckpointWriter : public StateVisitor {
 public:
  /// \param write  writes bytes at a place of the file
  CheckpointWriter(std::function<void(std::uint64_t, const void*, std::uint64_t)> write, const Ranks& ranks)
      : write_(std::move(write)), is_first_(ranks.is_first()) {
    if (is_first_) write_(0, kBegin.data(), kBegin.size());
    end_ = kBegin.size();
  }
  bool replaces() const override { return false; }

  /// Writes the table. Called on the first rank.
  std::uint64_t finish(const CheckpointInfo& info) {
    Json json;
    CheckpointInfo::each(info, [&](const char* name, const auto& value) { json[name] = value; });
    json["rows"] = std::move(pieces_);
    const std::string closing = ClosingTable::bytes(end_, json.dump(), kEnd);
    write_(end_, closing.data(), closing.size());
    return end_ + closing.size();
  }

 protected:
  void visit_piece(const std::string& name, const Piece& piece) override {
    note(name);
    if (!is_first_) return;
    const std::uint64_t bytes = piece.item * piece.count;
    pieces_.push_back({name, end_, piece.item, piece.count, XXH3_64bits(piece.data, bytes)});
    write_(end_, piece.data, bytes);
    end_ += bytes;
  }
  void visit_chunks(const std::string& name, const ChunksPiece& piece, Ranks& ranks) override {
    note(name);
    struct Chunk {
      int rank;
      std::uint64_t end, count, hash;  // where the first rank stands, and the chunk
    };
    std::vector<Chunk> own;
    const std::byte* data = piece.data;
    for (const std::uint64_t count : piece.counts) {
      own.push_back({ranks.me(), end_, count, XXH3_64bits(data, piece.item * count)});
      data += piece.item * count;
    }
    std::uint64_t before = 0, all = 0;
    std::vector<std::uint64_t> counts, hashes;
    const std::vector<Chunk> chunks = ranks.collect(own);
    for (const Chunk& chunk : chunks) {
      if (chunk.rank < ranks.me()) before += piece.item * chunk.count;
      all += piece.item * chunk.count;
      counts.push_back(chunk.count);
      hashes.push_back(chunk.hash);
    }
    if (!chunks.empty()) end_ = chunks.front().end;
    write_(end_ + before, piece.data, static_cast<std::uint64_t>(data - piece.data));
    if (is_first_) pieces_.push_back({name, end_, piece.item, counts, hashes});
    end_ += all;
  }

 private:
  void note(const std::string& name) {
    if (!names_.insert(name).second)
      throw Error(fmt::format("the state names \"{}\" twice", name));  // a fault of the program
  }

  std::function<void(std::uint64_t, const void*, std::uint64_t)> write_;
  bool is_first_;
  Json pieces_ = Json::array();
  std::set<std::string> names_;
  std::uint64_t end_ = 0;  ///< end of what is written, as far as this rank knows
};

/// Reads the entries of one chunk, or of all.
std::vector<std::uint64_t> read_list(const Json& json) {
  std::vector<std::uint64_t> list;
  for (const Json& entry : json.is_array() ? json : Json::array({json}))
    read_entry(entry, list.emplace_back());
  return list;
}

}  // namespace

/// Reader that replaces what it visits by the pieces of a checkpoint.
class CheckpointReader : public StateVisitor {
 public:
  explicit CheckpointReader(const CheckpointFile& checkpoint)
      : checkpoint_(checkpoint), file_(File::to_read(checkpoint.path())) {}
  bool replaces() const override { return true; }
  bool checks() const override { return true; }

  void finish() const {
    for (const auto& [name, piece] : checkpoint_.pieces_)
      if (!taken_.contains(name))
        refuse_body(fmt::format("holds \"{}\", which this run does not have", name));
  }
  /// Reads all pieces. Throws Error for the first that is damaged.
  void verify() {
    std::vector<std::byte> data;
    for (const auto& [name, piece] : checkpoint_.pieces_) {
      std::uint64_t from = piece.begin;
      for (std::size_t chunk = 0; chunk < piece.counts.size(); ++chunk) {
        data.resize(piece.item * piece.counts[chunk]);
        read(name, piece, chunk, from, data.data());
        from += data.size();
      }
    }
  }

 protected:
  void visit_piece(const std::string& name, const Piece& piece) override {
    const CheckpointFile::Piece& kept = take(name, false);
    const std::uint64_t count = kept.counts.front();
    require_same(name, {count, kept.item}, {piece.resize ? count : piece.count, piece.item});
    read(name, kept, 0, kept.begin, piece.resize ? piece.resize(count) : piece.data);
  }
  void visit_chunks(const std::string& name, const ChunksPiece& piece, Ranks& ranks) override {
    const CheckpointFile::Piece& kept = take(name, true);
    std::size_t first = 0, all = 0;
    const auto of_ranks = ranks.collect(std::vector<std::size_t>{piece.counts.size()});
    for (std::size_t rank = 0; rank < of_ranks.size(); ++rank) {
      if (std::cmp_less(rank, ranks.me())) first += of_ranks[rank];
      all += of_ranks[rank];
    }
    if (kept.counts.size() != all)
      refuse_body(
          fmt::format("holds {} chunks of \"{}\", but this run has {}", kept.counts.size(), name, all));
    std::uint64_t from = kept.begin;
    for (std::size_t chunk = 0; chunk < first; ++chunk) from += kept.item * kept.counts[chunk];
    const std::span own(kept.counts.data() + first, piece.counts.size());
    std::byte* to = piece.data;
    if (piece.resize) {
      std::ranges::copy(own, piece.counts.begin());
      to = piece.resize();
    }
    for (std::size_t i = 0; i < own.size(); ++i) {
      require_same(name, {own[i], kept.item}, {piece.counts[i], piece.item});
      read(name, kept, first + i, from, to);
      from += kept.item * own[i];
      to += kept.item * own[i];
    }
  }
  void refuse(const std::string& name, const std::string& what) const override {
    throw Error(fmt::format("{}: is not sound: \"{}\" {}", checkpoint_.path().string(), name, what));
  }

 private:
  /// Returns a piece by its name.
  const CheckpointFile::Piece& take(const std::string& name, bool is_by_chunk) {
    const auto found = checkpoint_.pieces_.find(name);
    if (found == checkpoint_.pieces_.end()) refuse_body(fmt::format("does not hold \"{}\"", name));
    const CheckpointFile::Piece& kept = found->second;
    if (kept.is_by_chunk != is_by_chunk) refuse_body(fmt::format("holds \"{}\" in another form", name));
    taken_.insert(name);
    return kept;
  }
  void read(const std::string& name, const CheckpointFile::Piece& piece, std::size_t chunk,
            std::uint64_t from, std::byte* data) const {
    const std::uint64_t bytes = piece.item * piece.counts[chunk];
    if ((bytes > 0 && !file_.read(from, data, bytes)) || XXH3_64bits(data, bytes) != piece.hashes[chunk])
      fail(fmt::format("is damaged: \"{}\"{} differs from the bytes that were written", name,
                       piece.is_by_chunk ? fmt::format(" of chunk {}", chunk) : ""));
  }
  struct Size {
    std::uint64_t count, item;
    bool operator==(const Size&) const = default;
  };
  void require_same(const std::string& name, const Size& kept, const Size& here) const {
    if (!(kept == here))
      refuse_body(fmt::format("holds {} x {} bytes of \"{}\", but this run has {} x {}", kept.count,
                              kept.item, name, here.count, here.item));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(fmt::format("{}: {}", checkpoint_.path().string(), what));
  }
  /// Refuses what a run of this build would not have written.
  [[noreturn]] void refuse_body(const std::string& what) const {
    const CheckpointInfo& info = checkpoint_.info();
    if (info.commit == kCommit) fail(what);
    fail(fmt::format(
        "{}; it was written by pyroclast {} ({}), and this is {} ({}): resume it with that build, or run "
        "its deck anew",
        what, info.version, info.commit, kVersion, kCommit));
  }

  const CheckpointFile& checkpoint_;
  File file_;
  std::set<std::string> taken_;
};

std::uint64_t write_checkpoint(const std::filesystem::path& path, const CheckpointInfo& info,
                               const std::function<void(StateVisitor&)>& visit, Ranks& ranks) {
  std::filesystem::path partial = path;
  partial += ".partial";
  std::optional<File> file;
  // A rank whose file fails goes through all collectives, so that the first one removes what was written.
  std::exception_ptr failure;
  const auto attempt = [&](const auto& act) {
    try {
      if (!failure) act();
    } catch (const Error&) {
      failure = std::current_exception();
    }
  };
  if (ranks.is_first()) attempt([&] { file.emplace(File::to_write(partial, path)); });
  ranks.any(true);  // now the file is there
  if (!ranks.is_first()) attempt([&] { file.emplace(File::of_other(partial)); });
  CheckpointWriter writer([&](std::uint64_t from, const void* data,
                              std::uint64_t bytes) { attempt([&] { file->write(from, data, bytes); }); },
                          ranks);
  visit(writer);
  if (!ranks.is_first()) attempt([&] { file->sync(); });
  const bool is_broken = ranks.any(failure != nullptr);
  std::uint64_t bytes = 0;
  if (ranks.is_first() && !is_broken) bytes = writer.finish(info);
  file.reset();
  std::error_code ignored;
  if (ranks.is_first() && (is_broken || failure)) std::filesystem::remove(partial, ignored);
  if (failure) std::rethrow_exception(failure);
  if (is_broken) ranks.any(true);  // the rank that failed ends all
  if (ranks.is_first()) publish(partial, path);
  return bytes;
}

CheckpointFile::CheckpointFile(std::filesystem::path path) : path_(std::move(path)) {
  const auto fail = [&](const std::string& what) {
    throw Error(fmt::format("{}: {}", path_.string(), what));
  };
  const File file = File::to_read(path_);
  const std::uint64_t size = file.size();
  std::array<char, 8> begin{};
  if (size < begin.size() || !file.read(0, begin.data(), begin.size()) || begin != kBegin)
    fail("is no checkpoint of pyroclast");
  if (ClosingTable::mark_of(file) == kEndOfOldForm)
    fail("is in an older form: resume it with the build that wrote it, or run its deck anew");
  const ClosingTable table = ClosingTable::read(file, kEnd, fail);
  try {
    const Json json = Json::parse(table.text);
    CheckpointInfo::each(info_, [&](const char* name, auto& value) { read_entry(json.at(name), value); });
    for (const Json& piece : json.at("rows")) {
      Piece r;
      read_entry(piece.at(1), r.begin);
      read_entry(piece.at(2), r.item);
      r.is_by_chunk = piece.at(3).is_array();
      r.counts = read_list(piece.at(3));
      r.hashes = read_list(piece.at(4));
      if (r.begin > size || r.item == 0 || r.counts.size() != r.hashes.size() ||
          (!r.is_by_chunk && r.counts.size() != 1))
        fail("is damaged in its table");
      std::uint64_t left = (size - r.begin) / r.item;
      for (const std::uint64_t count : r.counts) {
        if (count > left) fail("is damaged in its table");
        left -= count;
      }
      pieces_[piece.at(0).get<std::string>()] = r;
    }
  } catch (const Json::exception&) {
    fail("is of another version of pyroclast: its table has another form");
  }
}

void CheckpointFile::restore(const std::function<void(StateVisitor&)>& visit) const {
  const auto fail = [&](const char* what) {
    const std::string place = path_.string() + ": ";
    throw Error(std::string_view(what).starts_with(place) ? what
                                                          : fmt::format("{}is not sound: {}", place, what));
  };
  try {
    CheckpointReader reader(*this);
    visit(reader);
    reader.finish();
  } catch (const std::bad_alloc&) {
    fail("the file asks for more memory than there is");
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void CheckpointFile::verify() const {
  CheckpointReader(*this).verify();
}

}  // namespace pyroclast
