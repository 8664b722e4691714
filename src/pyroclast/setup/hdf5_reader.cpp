#include "pyroclast/setup/hdf5_reader.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "pyroclast/base/error.hpp"
#include "pyroclast/setup/hdf5_handle.hpp"

namespace pyroclast {

namespace {

using PropertyHandle = Hdf5Handle<H5Pclose>;

/// Returns the fault of the filters that pack an object; empty where there is none.
std::string fault_of_filters(hid_t properties) {
  for (int i = 0; i < H5Pget_nfilters(properties); ++i) {
    unsigned flags = 0;
    std::size_t none = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties, static_cast<unsigned>(i), &flags, &none, nullptr, 0, nullptr, nullptr);
    if (filter >= H5Z_FILTER_RESERVED)
      return fmt::format("is packed by filter {}, which is not a part of HDF5", static_cast<int>(filter));
  }
  return {};
}

/// Returns the fault of a dataset or group; empty where there is none.
std::string fault_of_object(hid_t object) {
  if (H5Iget_type(object) == H5I_GROUP)
    return fault_of_filters(PropertyHandle(H5Gget_create_plist(object)).id);
  if (H5Iget_type(object) != H5I_DATASET) return {};
  const PropertyHandle properties(H5Dget_create_plist(object));
  if (H5Pget_layout(properties.id) == H5D_VIRTUAL) return "is put together from other files";
  if (H5Pget_external_count(properties.id) > 0) return "keeps its numbers in another file";
  return fault_of_filters(properties.id);
}

/// Objects of the mesh to which frames link.
constexpr const char* kInMesh[] = {"Points",
                                   "Connectivity",
                                   "Offsets",
                                   "Types",
                                   "NumberOfPoints",
                                   "NumberOfCells",
                                   "NumberOfConnectivityIds",
                                   "block",
                                   "material",
                                   "bearing",
                                   "interface",
                                   "length",
                                   "area",
                                   "material_names",
                                   "interface_names"};

/// Tells whether a frame has such a link: to the object of the mesh that has its name, which in a frame may
/// have a unit ("CellData/length [m]" to /contacts/length).
bool is_of_a_frame(std::string_view link, std::string_view file, std::string_view object) {
  const std::string_view named = link.substr(link.rfind('/') + 1);
  const std::string_view name = named.substr(0, named.find(" ["));
  return file == kMeshFile && std::ranges::find(kInMesh, name) != std::end(kInMesh) &&
         (object == fmt::format("/blocks/{}", name) || object == fmt::format("/contacts/{}", name));
}

/// Faults of a file, as a walk over its links finds them.
struct WalkOfLinks {
  const std::filesystem::path& path;
  std::string fault;

  std::string fault_of_link(hid_t group, const char* name, const H5L_info_t& link) const {
    if (link.type == H5L_TYPE_HARD) {
      const Hdf5Handle<H5Oclose> object(H5Oopen(group, name, H5P_DEFAULT));
      return object.id < 0 ? "" : fault_of_object(object.id);  // nobody can read what cannot be opened
    }
    if (link.type != H5L_TYPE_EXTERNAL) return "is a link, and a run writes none there";
    std::vector<char> value(link.u.val_size);
    const char *file = nullptr, *object = nullptr;
    if (H5Lget_val(group, name, value.data(), value.size(), H5P_DEFAULT) < 0 ||
        H5Lunpack_elink_val(value.data(), value.size(), nullptr, &file, &object) < 0)
      return "is a link that cannot be read";
    if (!is_of_a_frame(name, file, object))
      return fmt::format("is a link to {} of the file {}", object, file);
    std::error_code none;
    if (std::filesystem::is_symlink(path.parent_path() / kMeshFile, none))
      return fmt::format("leads to {}, which is a link itself", kMeshFile);
    return "";
  }

  static herr_t look(hid_t group, const char* name, const H5L_info_t* link, void* walk) {
    auto& found = *static_cast<WalkOfLinks*>(walk);
    found.fault = found.fault_of_link(group, name, *link);
    if (found.fault.empty()) return 0;
    found.fault = fmt::format("/{} {}", name, found.fault);
    return 1;
  }
};

/// Tells whether a name leads to an object of the file by no link.
bool is_within(hid_t file, const std::string& name) {
  for (std::size_t end = 0; end != std::string::npos;) {
    end = name.find('/', end + 1);
    H5L_info_t link{};
    if (H5Lget_info(file, name.substr(0, end).c_str(), &link, H5P_DEFAULT) < 0 || link.type != H5L_TYPE_HARD)
      return false;
  }
  return true;
}

}  // namespace

Hdf5Reader::Hdf5Reader(const std::filesystem::path& path) : path_(path) {
  std::error_code none;
  if (path.filename() == kMeshFile && std::filesystem::is_symlink(path, none))
    throw Error(fmt::format("{}: is a link, and data of a run lie in its folder", path.string()));
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const PropertyHandle access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_fapl_sec2(access.id);  // whatever HDF5_DRIVER says
  file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.id);
  if (file_ < 0) throw Error(fmt::format("{}: is no file of HDF5", path.string()));
  WalkOfLinks walk{path_, fault_of_object(Hdf5Handle<H5Gclose>(H5Gopen2(file_, "/", H5P_DEFAULT)).id)};
  if (walk.fault.empty() && H5Lvisit(file_, H5_INDEX_NAME, H5_ITER_INC, WalkOfLinks::look, &walk) < 0)
    walk.fault = "cannot be read";
  if (walk.fault.empty()) return;
  H5Fclose(file_);
  throw Error(fmt::format("{}: is damaged: {}; data of a run lie in its folder", path.string(), walk.fault));
}

Hdf5Reader::~Hdf5Reader() {
  H5Fclose(file_);
}

std::vector<double> Hdf5Reader::numbers(const std::string& name) const {
  return read<double>(name, H5T_NATIVE_DOUBLE);
}

std::vector<std::int64_t> Hdf5Reader::integers(const std::string& name) const {
  return read<std::int64_t>(name, H5T_NATIVE_INT64);
}

template <class Number>
std::vector<Number> Hdf5Reader::read(const std::string& name, std::int64_t type) const {
  const auto refuse = [&] { throw Error(fmt::format("{}: {} cannot be read", path_.string(), name)); };
  if (!is_within(file_, name)) refuse();
  const Hdf5Handle<H5Dclose> set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT));
  if (set.id < 0) refuse();
  const hssize_t count = H5Sget_simple_extent_npoints(Hdf5Handle<H5Sclose>(H5Dget_space(set.id)).id);
  std::vector<Number> values(count > 0 ? static_cast<std::size_t>(count) : 0);
  if (count <= 0 || H5Dread(set.id, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) refuse();
  return values;
}

}  // namespace pyroclast
