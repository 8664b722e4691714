#include "pyroclast/results/checkpoint_file.hpp"

#include <array>
#include <bit>
#include <cerrno>
#include <cstring>
#include <exception>
#include <limits>
#include <new>
#include <set>
#include <span>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>
#include <xxhash.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/publish.hpp"
#include "pyroclast/version.hpp"

namespace pyroclast {

static_assert(std::endian::native == std::endian::little, "checkpoints hold numbers little end first");

namespace {

using Json = nlohmann::json;

constexpr std::array<char, 8> kBegin{'p', 'y', 'r', 'o', 'c', 'l', 'a', 's'};
constexpr std::array<char, 8> kEnd{'t', '-', 's', 't', 'a', 't', 'e', '1'};

/// Last bytes of a checkpoint.
struct Trailer {
  std::uint64_t table_begin = 0, table_bytes = 0, table_hash = 0;
  std::array<char, 8> end{};
};

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

/// File by its descriptor.
class File {
 public:
  static File to_read(const std::filesystem::path& path) {
    return {path, open(path.c_str(), O_RDONLY | O_CLOEXEC), "cannot be read"};
  }
  static File to_write(const std::filesystem::path& path) {
    return {path, open_aside(path), "cannot be written"};
  }
  ~File() { close(descriptor_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  void write(const void* data, std::uint64_t bytes) {
    if (!write_all(descriptor_, data, bytes)) fail("cannot be written");
  }
  /// Reads bytes from a place on; returns false where the file ends before.
  bool read(std::uint64_t from, void* data, std::uint64_t bytes) const {
    for (std::span rest(static_cast<char*>(data), bytes); !rest.empty();) {
      const ssize_t done =
          pread(descriptor_, rest.data(), rest.size(), static_cast<off_t>(from + bytes - rest.size()));
      if (done < 0 && errno == EINTR) continue;
      if (done < 0) fail("cannot be read");
      if (done == 0) return false;
      rest = rest.subspan(static_cast<std::size_t>(done));
    }
    return true;
  }
  std::uint64_t size() const {
    const off_t end = lseek(descriptor_, 0, SEEK_END);
    if (end < 0) fail("cannot be read");
    return static_cast<std::uint64_t>(end);
  }

 private:
  File(const std::filesystem::path& path, int descriptor, const char* why)
      : path_(path), descriptor_(descriptor) {
    if (descriptor_ < 0) fail(why);
  }
  [[noreturn]] void fail(const char* what) const {
    throw Error(fmt::format("{}: {} ({})", path_.string(), what, std::strerror(errno)));
  }

  const std::filesystem::path& path_;
  int descriptor_;
};

class CheckpointWriter : public StateVisitor {
 public:
  explicit CheckpointWriter(File& file) : file_(file) {
    file_.write(kBegin.data(), kBegin.size());
    end_ = kBegin.size();
  }
  bool replaces() const override { return false; }

  std::uint64_t finish(const CheckpointInfo& info) {
    Json json;
    CheckpointInfo::each(info, [&](const char* name, const auto& value) { json[name] = value; });
    json["rows"] = std::move(pieces_);
    const std::string table = json.dump();
    const Trailer trailer{end_, table.size(), XXH3_64bits(table.data(), table.size()), kEnd};
    file_.write(table.data(), table.size());
    file_.write(&trailer, sizeof(trailer));
    return end_ + table.size() + sizeof(trailer);
  }

 protected:
  void visit_piece(const std::string& name, const Piece& piece) override {
    if (!names_.insert(name).second)
      throw Error(fmt::format("the state names \"{}\" twice", name));  // a fault of the program
    const std::uint64_t bytes = piece.item * piece.count;
    pieces_.push_back({name, end_, piece.item, piece.count, XXH3_64bits(piece.data, bytes)});
    file_.write(piece.data, bytes);
    end_ += bytes;
  }

 private:
  File& file_;
  Json pieces_ = Json::array();
  std::set<std::string> names_;
  std::uint64_t end_ = 0;
};

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
      data.resize(piece.bytes());
      read(name, piece, data.data());
    }
  }

 protected:
  void visit_piece(const std::string& name, const Piece& piece) override {
    const auto found = checkpoint_.pieces_.find(name);
    if (found == checkpoint_.pieces_.end()) refuse_body(fmt::format("does not hold \"{}\"", name));
    const CheckpointFile::Piece& kept = found->second;
    if (kept.item != piece.item || (!piece.resize && kept.count != piece.count))
      refuse_body(fmt::format("holds {} x {} bytes of \"{}\", but this run has {} x {}", kept.count,
                              kept.item, name, piece.count, piece.item));
    read(name, kept, piece.resize ? piece.resize(kept.count) : piece.data);
    taken_.insert(name);
  }
  void refuse(const std::string& name, const std::string& what) const override {
    throw Error(fmt::format("{}: is not sound: \"{}\" {}", checkpoint_.path().string(), name, what));
  }

 private:
  void read(const std::string& name, const CheckpointFile::Piece& piece, std::byte* data) const {
    if ((piece.bytes() > 0 && !file_.read(piece.begin, data, piece.bytes())) ||
        XXH3_64bits(data, piece.bytes()) != piece.hash)
      fail(fmt::format("is damaged: \"{}\" differs from the bytes that were written", name));
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
                               const std::function<void(StateVisitor&)>& visit) {
  std::filesystem::path partial = path;
  partial += ".partial";
  std::uint64_t bytes = 0;
  try {
    File file = File::to_write(partial);
    CheckpointWriter writer(file);
    visit(writer);
    bytes = writer.finish(info);
  } catch (const Error&) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw;
  }
  publish(partial, path);
  return bytes;
}

CheckpointFile::CheckpointFile(std::filesystem::path path) : path_(std::move(path)) {
  const auto fail = [&](const std::string& what) {
    throw Error(fmt::format("{}: {}", path_.string(), what));
  };
  const File file = File::to_read(path_);
  const std::uint64_t size = file.size();
  std::array<char, 8> begin{};
  Trailer trailer;
  if (size < begin.size() || !file.read(0, begin.data(), begin.size()) || begin != kBegin)
    fail("is no checkpoint of pyroclast");
  if (size < begin.size() + sizeof(trailer) ||
      !file.read(size - sizeof(trailer), &trailer, sizeof(trailer)) || trailer.end != kEnd)
    fail("is cut short, or damaged at its end");
  if (trailer.table_bytes > size || trailer.table_begin > size ||
      trailer.table_begin + trailer.table_bytes + sizeof(trailer) != size)
    fail("is damaged at its end");
  std::string table(trailer.table_bytes, '\0');
  if (!file.read(trailer.table_begin, table.data(), table.size()) ||
      XXH3_64bits(table.data(), table.size()) != trailer.table_hash)
    fail("is damaged: its table has another hash");
  try {
    const Json json = Json::parse(table);
    CheckpointInfo::each(info_, [&](const char* name, auto& value) { read_entry(json.at(name), value); });
    for (const Json& piece : json.at("rows")) {
      Piece r;
      read_entry(piece.at(1), r.begin);
      read_entry(piece.at(2), r.item);
      read_entry(piece.at(3), r.count);
      read_entry(piece.at(4), r.hash);
      if (r.begin > size || r.item == 0 || r.count > (size - r.begin) / r.item)
        fail("is damaged in its table");
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
