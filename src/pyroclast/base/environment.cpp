#include "pyroclast/base/environment.hpp"

#include <charconv>
#include <cstdlib>
#include <sstream>

namespace pyroclast {

namespace {

/// Variables with one path, or with several and a colon between two.
constexpr const char* kPlaces[] = {
    "PATH",
    // the loader and the compiler
    "LD_LIBRARY_PATH",
    "CPATH",
    "C_INCLUDE_PATH",
    "CPLUS_INCLUDE_PATH",
    "LIBRARY_PATH",
    "COMPILER_PATH",
    "GCC_EXEC_PREFIX",
    // HDF5
    "HDF5_PLUGIN_PATH",
    "HDF5_EXT_PREFIX",
    "HDF5_EXTFILE_PREFIX",
    "HDF5_VDS_PREFIX",
    // Python, Matplotlib and OpenTURNS
    "PYTHONHOME",
    "PYTHONUSERBASE",
    "MATPLOTLIBRC",
    "MPLCONFIGDIR",
    "OPENTURNS_CONFIG_PATH",
    "XDG_CONFIG_HOME",
    "XDG_CACHE_HOME",
};

}  // namespace

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

std::optional<int> number_in_environment(const char* name) {
  const std::string text = environment(name);
  int number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

void forget_current_folder() {
  for (const char* const name : kPlaces) {
    const std::string stated = environment(name);
    std::string kept;
    std::istringstream places(stated);
    for (std::string place; std::getline(places, place, ':');)
      if (place.starts_with('/')) {
        if (!kept.empty()) kept += ':';
        kept += place;
      }
    if (kept == stated) continue;
    if (kept.empty())
      unsetenv(name);
    else
      setenv(name, kept.c_str(), 1);
  }
}

}  // namespace pyroclast
