#include "pyroclast/results/hdf5_file.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <hdf5.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/publish.hpp"
#include "pyroclast/setup/hdf5_handle.hpp"
#include "pyroclast/setup/hdf5_reader.hpp"

namespace pyroclast {

namespace {

/// List of HDF5 properties.
class PropertyList {
 public:
  explicit PropertyList(hid_t kind) : id_(H5Pcreate(kind)) {}
  ~PropertyList() { H5Pclose(id_); }
  PropertyList(const PropertyList&) = delete;
  PropertyList& operator=(const PropertyList&) = delete;
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor)

 private:
  hid_t id_;
};

/// Properties of something new, without the times at which it is written: equal runs give equal files.
class Untimed : public PropertyList {
 public:
  explicit Untimed(hid_t kind) : PropertyList(kind) { H5Pset_obj_track_times(*this, false); }
};

/// Returns the type of a dataset with numbers of a kind.
hid_t type_of(double /*kind*/) {
  return H5T_NATIVE_DOUBLE;
}
hid_t type_of(float /*kind*/) {
  return H5T_NATIVE_FLOAT;
}
hid_t type_of(std::int64_t /*kind*/) {
  return H5T_NATIVE_INT64;
}
hid_t type_of(std::int32_t /*kind*/) {
  return H5T_NATIVE_INT32;
}
hid_t type_of(std::uint8_t /*kind*/) {
  return H5T_NATIVE_UINT8;
}

}  // namespace

/// Driver of HDF5 by which the library writes into the file of an Hdf5File. It never tells the library of a
/// failure, for the library does not survive a disk that fills up. It reads nothing: the library keeps what
/// it describes of a file that is being made.
struct Hdf5Driver : H5FD_t {
  Hdf5File* file;
  haddr_t end;  ///< end of what the library has taken

  static hid_t id() {
    static const hid_t registered = [] {
      H5FD_class_t driver{};
#ifdef H5FD_CLASS_VERSION  // from HDF5 1.14 on
      constexpr int kOwnValue = 512;
      driver.version = H5FD_CLASS_VERSION;
      driver.value = static_cast<H5FD_class_value_t>(kOwnValue);
#endif
      driver.name = "pyroclast";
      driver.maxaddr = std::numeric_limits<std::int64_t>::max();
      driver.fc_degree = H5F_CLOSE_STRONG;
      driver.fapl_size = sizeof(Hdf5File*);
      driver.open = open;
      driver.close = close;
      driver.query = query;
      driver.get_eoa = end_of;
      driver.set_eoa = set_end;
      driver.get_eof = end_of;
      driver.read = read;
      driver.write = write;
      driver.truncate = truncate;
      return H5FDregister(&driver);
    }();
    return registered;
  }

 private:
  static Hdf5Driver& of(H5FD_t* file) {
    return *static_cast<Hdf5Driver*>(file);
  }
  static H5FD_t* open(const char* /*name*/, unsigned /*flags*/, hid_t access, haddr_t /*most*/) {
    auto made = std::make_unique<Hdf5Driver>();
    made->file = *static_cast<Hdf5File* const*>(H5Pget_driver_info(access));
    return made.release();
  }
  static herr_t close(H5FD_t* file) {
    const std::unique_ptr<Hdf5Driver> gone(static_cast<Hdf5Driver*>(file));
    return 0;
  }
  static herr_t query(const H5FD_t* /*file*/, unsigned long* flags) {
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_AGGREGATE_SMALLDATA | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
  }
  static haddr_t end_of(const H5FD_t* file, H5FD_mem_t /*kind*/) {
    return static_cast<const Hdf5Driver*>(file)->end;
  }
  static herr_t set_end(H5FD_t* file, H5FD_mem_t /*kind*/, haddr_t end) {
    of(file).end = end;
    return 0;
  }
  static herr_t read(H5FD_t* /*file*/, H5FD_mem_t /*kind*/, hid_t /*transfer*/, haddr_t /*from*/,
                     std::size_t /*bytes*/, void* /*data*/) {
    return -1;
  }
  static herr_t write(H5FD_t* file, H5FD_mem_t /*kind*/, hid_t /*transfer*/, haddr_t from, std::size_t bytes,
                      const void* data) {
    Hdf5File& to = *of(file).file;
    to.attempt([&] { to.disk_->write(from, data, bytes); });
    return 0;
  }
  static herr_t truncate(H5FD_t* file, hid_t /*transfer*/, hbool_t /*closes*/) {
    Hdf5File& to = *of(file).file;
    to.attempt([&] { to.disk_->resize(of(file).end); });
    return 0;
  }
};

Hdf5File::Hdf5File(std::filesystem::path path, Ranks& ranks) : path_(std::move(path)), ranks_(&ranks) {
  if (path_.empty()) return;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  disk_.emplace(File::to_write(partial(), path_));
  const PropertyList access(H5P_FILE_ACCESS);
  const Hdf5File* const self = this;
  H5Pset_driver(access, Hdf5Driver::id(), &self);
  file_ = H5Fcreate(path_.c_str(), H5F_ACC_TRUNC, Untimed(H5P_FILE_CREATE), access);
  if (file_ < 0) fail("cannot be created");
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
  give_up();
}

void Hdf5File::give_up() {
  if (!disk_) return;
  disk_.reset();
  std::error_code ignored;
  if (ranks_->is_first()) std::filesystem::remove(partial(), ignored);
}

void Hdf5File::fail(const std::string& what) const {
  throw Error(fmt::format("{}: {}", path_.string(), what));
}

void Hdf5File::attempt(const std::function<void()>& act) {
  try {
    if (!failure_) act();
  } catch (const Error&) {
    failure_ = std::current_exception();
  }
}

void Hdf5File::group(const std::string& name) {
  if (!describes()) return;
  const Hdf5Handle<H5Gclose> group{
      H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, Untimed(H5P_GROUP_CREATE), H5P_DEFAULT)};
  if (group.id < 0) fail("group " + name + " cannot be written");
}

void Hdf5File::make_room(const std::string& name, std::int64_t type, std::int64_t rows, int columns) {
  Room& room = rooms_[name];
  if (!describes()) return;
  const hsize_t width = columns > 0 ? static_cast<hsize_t>(columns) : 1;
  const hsize_t dims[2] = {static_cast<hsize_t>(rows), width};
  const Hdf5Handle<H5Sclose> space{H5Screate_simple(columns > 0 ? 2 : 1, dims, nullptr)};
  // Datasets are not compressed: shuffled and deflated, the frames of cases/starter.toml are 1.6 times
  // smaller and take 7 % of its processor time.
  const Untimed layout(H5P_DATASET_CREATE);
  H5Pset_alloc_time(layout, H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(layout, H5D_FILL_TIME_NEVER);
  const Hdf5Handle<H5Dclose> set{
      H5Dcreate2(file_, name.c_str(), type, space.id, H5P_DEFAULT, layout, H5P_DEFAULT)};
  const haddr_t place = set.id < 0 ? HADDR_UNDEF : H5Dget_offset(set.id);
  if (set.id < 0 || (rows > 0 && place == HADDR_UNDEF)) fail("dataset " + name + " cannot be written");
  room = {place == HADDR_UNDEF ? 0 : place, width * H5Tget_size(type)};
}

void Hdf5File::share() {
  if (ranks_->count() == 1) return;
  const std::string own = path_.string();
  const auto path = ranks_->is_first() ? std::vector<char>(own.begin(), own.end()) : std::vector<char>();
  std::vector<Room> rooms;
  for (const auto& [name, room] : rooms_)
    if (ranks_->is_first()) rooms.push_back(room);
  const auto [of_first, places] =
      ranks_->together([&] { return std::pair(ranks_->collect(path), ranks_->collect(rooms)); });
  if (ranks_->is_first() || of_first.empty()) return;
  path_ = std::string(of_first.begin(), of_first.end());
  if (!disk_) attempt([&] { disk_.emplace(File::of_other(partial())); });
  auto place = places.begin();
  for (auto& [name, room] : rooms_) room = *place++;
}

template <class T>
void Hdf5File::room(const std::string& name, std::int64_t rows, int columns) {
  make_room(name, type_of(T{}), rows, columns);
}
template void Hdf5File::room<double>(const std::string&, std::int64_t, int);
template void Hdf5File::room<float>(const std::string&, std::int64_t, int);
template void Hdf5File::room<std::int64_t>(const std::string&, std::int64_t, int);
template void Hdf5File::room<std::int32_t>(const std::string&, std::int64_t, int);
template void Hdf5File::room<std::uint8_t>(const std::string&, std::int64_t, int);

void Hdf5File::write(const std::string& name, std::int64_t first, const void* data, std::size_t bytes) {
  const Room& room = rooms_[name];
  if (!disk_ || room.row == 0) return;  // not shared
  const std::uint64_t from = room.place + static_cast<std::uint64_t>(first) * room.row;
  if (ranks_->is_first())
    disk_->write(from, data, bytes);
  else
    attempt([&] { disk_->write(from, data, bytes); });  // told by `close`
}

void Hdf5File::dataset(const std::string& name, const std::vector<std::string>& v) {
  rooms_.try_emplace(name);
  if (!describes()) return;
  std::size_t longest = 1;
  for (const std::string& text : v) longest = std::max(longest, text.size());
  std::string padded;
  for (const std::string& text : v) padded += text + std::string(longest - text.size(), '\0');
  const Hdf5Handle<H5Tclose> type{H5Tcopy(H5T_C_S1)};
  H5Tset_size(type.id, longest);
  H5Tset_strpad(type.id, H5T_STR_NULLPAD);
  H5Tset_cset(type.id, H5T_CSET_UTF8);
  make_room(name, type.id, std::ssize(v), 0);
  write(name, 0, padded.data(), padded.size());
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                               std::int64_t space, const void* data) {
  if (!describes()) return;
  const Hdf5Handle<H5Aclose> attribute{H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space,
                                                         H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)};
  if (attribute.id < 0 || H5Awrite(attribute.id, type, data) < 0)
    fail("attribute " + name + " cannot be written");
}

void Hdf5File::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Hdf5Handle<H5Tclose> type{H5Tcopy(H5T_C_S1)};
  H5Tset_size(type.id, text.size());
  H5Tset_strpad(type.id, H5T_STR_NULLPAD);
  const Hdf5Handle<H5Sclose> space{H5Screate(H5S_SCALAR)};
  write_attribute(object, name, type.id, space.id, text.data());
}

void Hdf5File::attribute(const std::string& object, const std::string& name, double value) {
  const Hdf5Handle<H5Sclose> space{H5Screate(H5S_SCALAR)};
  write_attribute(object, name, H5T_NATIVE_DOUBLE, space.id, &value);
}

void Hdf5File::attribute(const std::string& object, const std::string& name,
                         const std::vector<std::int64_t>& values) {
  const hsize_t count = values.size();
  const Hdf5Handle<H5Sclose> space{H5Screate_simple(1, &count, nullptr)};
  write_attribute(object, name, H5T_NATIVE_INT64, space.id, values.data());
}

void Hdf5File::external_link(const std::string& name, const std::string& file, const std::string& object) {
  if (!describes()) return;
  if (H5Lcreate_external(file.c_str(), object.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) < 0)
    fail("link " + name + " cannot be written");
}

bool Hdf5File::is_whole(const std::filesystem::path& path) {
  try {
    const Hdf5Reader reader(path);
    return true;
  } catch (const Error&) {
    return false;
  }
}

void Hdf5File::end() {
  if (file_ >= 0 && H5Fclose(std::exchange(file_, -1)) < 0 && !failure_) fail("cannot be made");
  if (failure_) std::rethrow_exception(failure_);
}

void Hdf5File::append(const std::function<std::string(const File&)>& more) {
  if (!disk_) return;
  end();
  const std::string text = more(*disk_);
  disk_->write(disk_->size(), text.data(), text.size());
}

void Hdf5File::close() {
  if (describes()) end();
  if (ranks_->count() > 1) {
    if (disk_) attempt([&] { disk_->sync(); });
    if (ranks_->any(failure_ != nullptr)) {
      give_up();
      ranks_->any(true);  // now the file is gone
      if (failure_) std::rethrow_exception(failure_);
      ranks_->any(true);  // the rank that failed ends all
    }
  }
  if (!disk_) return;
  disk_.reset();
  if (ranks_->is_first()) publish(partial(), path_);
}

}  // namespace pyroclast
