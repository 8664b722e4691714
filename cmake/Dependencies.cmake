# Every dependency is a Debian package; docs/develop/dependencies.md gives the reason for each.
find_package(Threads REQUIRED)
find_package(fmt REQUIRED)
find_package(spdlog REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(muparser REQUIRED)

if(PYROCLAST_SANITIZE)
  # toml++ from its headers, so that its parser is checked like the rest; without assertions, as Debian builds it: one
  # of them fails at "[{", of which the parser then says what is wrong.
  set_target_properties(tomlplusplus::tomlplusplus PROPERTIES INTERFACE_COMPILE_OPTIONS
                                                              "-DTOML_ASSERT(expr)=static_assert(true)")
endif()

# UDUNITS-2, Voro++, KLU, libmd and xxHash ship no CMake package; that of HDF5 would need a project that has C.
function(pyroclast_find_library name header library)
  find_path(${name}_INCLUDE_DIR ${header} PATH_SUFFIXES ${ARGN} REQUIRED)
  find_library(${name}_LIBRARY ${library} REQUIRED)
  add_library(${name}::${name} UNKNOWN IMPORTED)
  set_target_properties(${name}::${name} PROPERTIES IMPORTED_LOCATION ${${name}_LIBRARY}
                                                    INTERFACE_INCLUDE_DIRECTORIES ${${name}_INCLUDE_DIR})
endfunction()
pyroclast_find_library(udunits2 udunits2.h udunits2 udunits2)
pyroclast_find_library(voropp voro++.hh voro++ voro++)
pyroclast_find_library(polyclipping clipper.hpp polyclipping polyclipping)
pyroclast_find_library(klu klu.h klu suitesparse)
pyroclast_find_library(libmd sha256.h md)
pyroclast_find_library(xxhash xxhash.h xxhash)
pyroclast_find_library(hdf5 hdf5.h hdf5_serial hdf5/serial)
