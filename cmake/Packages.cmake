# Debian packages by CPack, one set for the release of Debian that builds them; packaging/debian runs it there.
# libpyroclast has the shared library; libpyroclast-dev what programs and contact laws of one's own are built with;
# pyroclast the program and the package for Python.
if(NOT EXISTS /etc/debian_version OR NOT BUILD_SHARED_LIBS)
  return()
endif()
file(STRINGS /etc/os-release release REGEX "^VERSION_ID=")
string(REGEX REPLACE "[^0-9]" "" release "${release}")
find_package(Python 3 REQUIRED COMPONENTS Interpreter)
math(EXPR next_minor "${Python_VERSION_MINOR} + 1")

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_CONTACT "The Pyroclast developers <developers@pyroclast.invalid>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENT_PROGRAM_GROUP program)
set(CPACK_COMPONENT_MODULE_GROUP program)
set(CPACK_COMPONENT_LIBRARY_GROUP library)
set(CPACK_COMPONENT_LAWS_GROUP development)
set(CPACK_COMPONENT_DEVELOPMENT_GROUP development)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1~deb${release})
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/src/pyroclast) # no expression is read here
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(same_version "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME libpyroclast)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_DESCRIPTION "simulation of concrete under load and fire - shared library
 Pyroclast simulates how concrete breaks under load and fire, by the discrete
 element method at the meso-scale. This package has its library.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libpyroclast-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libpyroclast ${same_version}, libfmt-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "cmake, g++")
set(CPACK_DEBIAN_DEVELOPMENT_DESCRIPTION "simulation of concrete under load and fire - headers
 Pyroclast simulates how concrete breaks under load and fire, by the discrete
 element method at the meso-scale. This package has the headers and CMake files
 for programs that use its library and for contact laws of one's own.")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME pyroclast)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS
    "libpyroclast ${same_version}, python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_minor}), python3-numpy, \
python3-h5py, python3-matplotlib, python3-scipy, python3-cmaes, python3-jinja2")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS
    "libpyroclast-dev ${same_version}, g++, paraview, python3-pandas, python3-xarray, python3-openturns, \
python3-emcee")
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "simulation of concrete under load and fire
 Pyroclast simulates how concrete breaks under load and fire, by the discrete
 element method at the meso-scale. A specimen of aggregates, mortar and their
 interfaces is made, loaded, heated, cracked, measured and drawn from a short
 input file. This package has the program and the package for Python.")

# Debian wants the licence under this name
set(components library development program)
set(names libpyroclast libpyroclast-dev pyroclast)
foreach(component name IN ZIP_LISTS components names)
  install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} RENAME copyright COMPONENT ${component})
endforeach()
include(CPack)
