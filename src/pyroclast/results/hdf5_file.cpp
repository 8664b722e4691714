#include "pyroclast/results/hdf5_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <hdf5.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/text_file.hpp"
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

}  // namespace

Hdf5File::Hdf5File(std::filesystem::path path) : path_(std::move(path)) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  // The file grows in memory and `close` writes it: the library does not survive a disk that fills up.
  constexpr std::size_t kGrowth = std::size_t{1} << 20;
  const PropertyList access(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, kGrowth, false);
  file_ =
      H5Fcreate(path_.empty() ? "nowhere" : path_.c_str(), H5F_ACC_TRUNC, Untimed(H5P_FILE_CREATE), access);
  if (file_ < 0) fail("cannot be created");
}

Hdf5File::~Hdf5File() {
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::fail(const std::string& what) const {
  const int cause = errno;
  throw Error(fmt::format("{}: {}{}", path_.string(), what,
                          cause != 0 ? fmt::format(" ({})", std::strerror(cause)) : ""));
}

void Hdf5File::group(const std::string& name) {
  const Hdf5Handle<H5Gclose> group{
      H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, Untimed(H5P_GROUP_CREATE), H5P_DEFAULT)};
  if (group.id < 0) fail("group " + name + " cannot be written");
}

void Hdf5File::write(const std::string& name, std::int64_t type, const void* data, std::size_t count,
                     int columns) {
  const hsize_t width = columns > 0 ? static_cast<hsize_t>(columns) : 1;
  const hsize_t dims[2] = {count / width, width};
  const int rank = columns > 0 ? 2 : 1;
  const Hdf5Handle<H5Sclose> space{H5Screate_simple(rank, dims, nullptr)};
  // Datasets are not compressed: shuffled and deflated, the frames of cases/starter.toml are 1.6 times
  // smaller and take 7 % of its processor time.
  const Hdf5Handle<H5Dclose> set{
      H5Dcreate2(file_, name.c_str(), type, space.id, H5P_DEFAULT, Untimed(H5P_DATASET_CREATE), H5P_DEFAULT)};
  if (set.id < 0 || (count > 0 && H5Dwrite(set.id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0))
    fail("dataset " + name + " cannot be written");
}

void Hdf5File::dataset(const std::string& name, const std::vector<double>& v, int columns) {
  write(name, H5T_NATIVE_DOUBLE, v.data(), v.size(), columns);
}
void Hdf5File::dataset(const std::string& name, const std::vector<float>& v, int columns) {
  write(name, H5T_NATIVE_FLOAT, v.data(), v.size(), columns);
}
void Hdf5File::dataset(const std::string& name, const std::vector<std::int64_t>& v, int columns) {
  write(name, H5T_NATIVE_INT64, v.data(), v.size(), columns);
}
void Hdf5File::dataset(const std::string& name, const std::vector<std::int32_t>& v, int columns) {
  write(name, H5T_NATIVE_INT32, v.data(), v.size(), columns);
}
void Hdf5File::dataset(const std::string& name, const std::vector<std::uint8_t>& v, int columns) {
  write(name, H5T_NATIVE_UINT8, v.data(), v.size(), columns);
}

void Hdf5File::dataset(const std::string& name, const std::vector<std::string>& v) {
  std::size_t longest = 1;
  for (const std::string& text : v) longest = std::max(longest, text.size());
  std::string padded;
  for (const std::string& text : v) padded += text + std::string(longest - text.size(), '\0');
  const Hdf5Handle<H5Tclose> type{H5Tcopy(H5T_C_S1)};
  H5Tset_size(type.id, longest);
  H5Tset_strpad(type.id, H5T_STR_NULLPAD);
  H5Tset_cset(type.id, H5T_CSET_UTF8);
  write(name, type.id, padded.data(), v.size(), 0);
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                               std::int64_t space, const void* data) {
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

std::uint64_t Hdf5File::place_of(const std::string& name) const {
  const Hdf5Handle<H5Dclose> set{H5Dopen2(file_, name.c_str(), H5P_DEFAULT)};
  const haddr_t place = set.id < 0 ? HADDR_UNDEF : H5Dget_offset(set.id);
  return place == HADDR_UNDEF ? 0 : place;
}

std::string Hdf5File::image() {
  errno = 0;
  if (H5Fflush(file_, H5F_SCOPE_LOCAL) < 0) fail("cannot be made");
  const ssize_t bytes = H5Fget_file_image(file_, nullptr, 0);
  std::string image(bytes > 0 ? static_cast<std::size_t>(bytes) : 0, '\0');
  if (bytes <= 0 || H5Fget_file_image(file_, image.data(), image.size()) != bytes) fail("cannot be made");
  H5Fclose(file_);
  file_ = -1;
  return image;
}

void Hdf5File::close() {
  const std::string bytes = image();
  if (!path_.empty()) write_text_file(path_, bytes);
}

}  // namespace pyroclast
