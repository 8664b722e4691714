#include "pyroclast/results/hdf5_file.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <hdf5.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/results/publish.hpp"

namespace pyroclast {

namespace {

/// Closes an HDF5 identifier at the end of its scope.
template <herr_t (*Close)(hid_t)>
struct Handle {
  hid_t id;
  ~Handle() {
    if (id >= 0) Close(id);
  }
};

}  // namespace

Hdf5File::Hdf5File(std::filesystem::path path) : path_(std::move(path)), partial_(path_) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  partial_ += ".partial";
  file_ = H5Fcreate(partial_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  if (file_ < 0) fail("cannot be created");
}

Hdf5File::~Hdf5File() {
  if (file_ < 0) return;
  H5Fclose(file_);
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

void Hdf5File::fail(const std::string& what) const {
  const int cause = errno;
  throw Error(fmt::format("{}: {}{}", path_.string(), what,
                          cause != 0 ? fmt::format(" ({})", std::strerror(cause)) : ""));
}

void Hdf5File::group(const std::string& name) {
  const Handle<H5Gclose> group{H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)};
  if (group.id < 0) fail("group " + name + " cannot be written");
}

void Hdf5File::write(const std::string& name, std::int64_t type, const void* data, std::size_t count,
                     int columns) {
  const hsize_t width = columns > 0 ? static_cast<hsize_t>(columns) : 1;
  const hsize_t dims[2] = {count / width, width};
  const int rank = columns > 0 ? 2 : 1;
  const Handle<H5Sclose> space{H5Screate_simple(rank, dims, nullptr)};
  // Not compressed: most bytes of a field are noise, and deflating a frame takes as long as 150 steps.
  const Handle<H5Dclose> set{
      H5Dcreate2(file_, name.c_str(), type, space.id, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)};
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

void Hdf5File::write_attribute(const std::string& object, const std::string& name, std::int64_t type,
                               std::int64_t space, const void* data) {
  const Handle<H5Aclose> attribute{H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space,
                                                     H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)};
  if (attribute.id < 0 || H5Awrite(attribute.id, type, data) < 0)
    fail("attribute " + name + " cannot be written");
}

void Hdf5File::attribute(const std::string& object, const std::string& name, const std::string& text) {
  const Handle<H5Tclose> type{H5Tcopy(H5T_C_S1)};
  H5Tset_size(type.id, text.size());
  H5Tset_strpad(type.id, H5T_STR_NULLPAD);
  const Handle<H5Sclose> space{H5Screate(H5S_SCALAR)};
  write_attribute(object, name, type.id, space.id, text.data());
}

void Hdf5File::attribute(const std::string& object, const std::string& name, double value) {
  const Handle<H5Sclose> space{H5Screate(H5S_SCALAR)};
  write_attribute(object, name, H5T_NATIVE_DOUBLE, space.id, &value);
}

void Hdf5File::attribute(const std::string& object, const std::string& name,
                         const std::vector<std::int64_t>& values) {
  const hsize_t count = values.size();
  const Handle<H5Sclose> space{H5Screate_simple(1, &count, nullptr)};
  write_attribute(object, name, H5T_NATIVE_INT64, space.id, values.data());
}

void Hdf5File::external_link(const std::string& name, const std::string& file, const std::string& object) {
  if (H5Lcreate_external(file.c_str(), object.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) < 0)
    fail("link " + name + " cannot be written");
}

void Hdf5File::close() {
  errno = 0;
  const bool flushed = H5Fflush(file_, H5F_SCOPE_LOCAL) >= 0;
  const int cause = errno;
  const bool closed = H5Fclose(file_) >= 0;
  file_ = -1;
  if (!flushed || !closed) {
    std::error_code ignored;
    std::filesystem::remove(partial_, ignored);
    if (!flushed) errno = cause;
    fail("cannot be written");
  }
  publish(partial_, path_);
}

}  // namespace pyroclast
