# Installs the build into a folder of its own, then configures, builds and runs projects that use it.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed)
  if(failed)
    message(FATAL_ERROR "failed: ${ARGN}")
  endif()
endfunction()
file(REMOVE_RECURSE ${WORK})
execute_process(COMMAND ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix OUTPUT_VARIABLE said
                COMMAND_ERROR_IS_FATAL ANY)
foreach(project tests/install examples)
  run(${CMAKE_COMMAND} -G Ninja -S ${SOURCE}/${project} -B ${WORK}/${project} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
  run(${CMAKE_COMMAND} --build ${WORK}/${project})
endforeach()
run(${WORK}/tests/install/consumer)
file(READ ${SOURCE}/cases/thermal_wall.toml deck)
string(REPLACE "count = 2000" "count = 50" deck "${deck}")
string(REPLACE "duration = \"2 h\"" "duration = \"1 min\"" deck "${deck}")
file(WRITE ${WORK}/deck.toml "${deck}")
run(${WORK}/examples/run_deck ${WORK}/deck.toml ${WORK}/out)
run(${WORK}/prefix/bin/pyroclast --version)

# What the installation says of the package for Python, and the doctor too, is all that a script needs.
string(REGEX MATCH "import pyroclast: export PYTHONPATH='([^'\n]+)'" found "${said}")
set(python_package ${CMAKE_MATCH_1})
run(${CMAKE_COMMAND} -E chdir ${WORK} ${CMAKE_COMMAND} -E env PYTHONPATH=${python_package} ${PYTHON} -c
    "import pyroclast, sys; assert pyroclast.__file__.startswith(sys.argv[1]); pyroclast.Deck('deck.toml').check()"
    ${WORK}/prefix)
execute_process(COMMAND ${WORK}/prefix/bin/pyroclast doctor OUTPUT_VARIABLE said COMMAND_ERROR_IS_FATAL ANY)
string(FIND "${said}" "${python_package}" at)
if(at EQUAL -1)
  message(FATAL_ERROR "the doctor does not say where the package lies: ${said}")
endif()

# A contact law of one's own: built from the headers alone, in a build without optimization, loaded and driven by the
# installed program; from the header, which the program compiles, it gives the same numbers. One instruction set is
# enough here; tests/plugin has them all.
set(without)
foreach(package muparser fmt spdlog CLI11 tomlplusplus nlohmann_json Threads)
  list(APPEND without -DCMAKE_DISABLE_FIND_PACKAGE_${package}=ON)
endforeach()
set(own_law ${SOURCE}/examples/own_law)
run(${CMAKE_COMMAND} -G Ninja -S ${own_law} -B ${WORK}/own_law -DCMAKE_PREFIX_PATH=${WORK}/prefix
    -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS=-ffast-math -DPYROCLAST_LAW_SETS=${SET} ${without})
run(${CMAKE_COMMAND} --build ${WORK}/own_law)
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/own_law --output-on-failure)
set(properties --set "G_n=60 N/m" --set "G_t=240 N/m" --set "sigma_max=2.5 MPa" --set "tau_max=4 MPa"
    --set alpha=5 --set beta=2 --set lambda_n=0.01 --set lambda_t=0.01 --set friction=0.6)
set(ENV{PYROCLAST_CACHE} ${WORK}/cache)
foreach(law ppr ${own_law}/ppr.hpp)
  get_filename_component(extension ${law} LAST_EXT)
  run(${WORK}/prefix/bin/pyroclast law --law ${law} --law-path ${WORK}/own_law ${properties} --path ${own_law}/path.csv
      --steps 200 -o ${WORK}/path${extension}.csv)
endforeach()
run(${CMAKE_COMMAND} -E compare_files ${WORK}/path.csv ${WORK}/path.hpp.csv)
run(${PYTHON} ${own_law}/figure.py ${WORK}/path.csv ${WORK}/path.png)
