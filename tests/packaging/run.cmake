# One packaging test; CMakeLists.txt beside this file says with what arguments.
cmake_minimum_required(VERSION 3.25)

function(run)
  execute_process(COMMAND ${ARGV} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# Runs the program, which must print the version and nothing else.
function(expect_version)
  execute_process(COMMAND ${ARGV} OUTPUT_VARIABLE output COMMAND_ECHO STDOUT
    COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output STREQUAL "${VERSION}\n")
    message(FATAL_ERROR "expected ${VERSION}, got ${output}")
  endif()
endfunction()

function(configure source build)
  run("${CMAKE_COMMAND}" -S "${source}" -B "${build}" -G "${GENERATOR}"
      "-DCMAKE_CXX_COMPILER=${CXX}" ${ARGN})
endfunction()

function(build_consumer)
  configure("${CMAKE_CURRENT_LIST_DIR}/consumer" "${scratch}/consumer"
    "-DCMAKE_BUILD_TYPE=${CONFIG}" "-DVERSION=${VERSION}" ${ARGN})
  run("${CMAKE_COMMAND}" --build "${scratch}/consumer" --config "${CONFIG}")
  find_program(consumer consumer NO_CACHE REQUIRED NO_DEFAULT_PATH
    PATHS "${scratch}/consumer" "${scratch}/consumer/${CONFIG}")
  expect_version("${consumer}")
endfunction()

function(install_moved build prefix)
  run("${CMAKE_COMMAND}" --install "${build}" --config "${CONFIG}" --prefix "${scratch}/first")
  file(REMOVE_RECURSE "${prefix}")
  file(RENAME "${scratch}/first" "${prefix}")
endfunction()

set(scratch "${WORK_DIR}/${CASE}")
file(REMOVE_RECURSE "${scratch}")
file(MAKE_DIRECTORY "${scratch}")

if(CASE STREQUAL "install")
  install_moved("${BUILD_DIR}" "${PREFIX}")
  file(GLOB_RECURSE texts "${PREFIX}/*.cmake" "${PREFIX}/*.pc")
  foreach(text IN LISTS texts)
    file(READ "${text}" content)
    foreach(path IN ITEMS "${SOURCE_DIR}" "${BUILD_DIR}")
      string(FIND "${content}" "${path}" position)
      if(NOT position EQUAL -1)
        message(SEND_ERROR "${text} names ${path}")
      endif()
    endforeach()
  endforeach()

elseif(CASE STREQUAL "find_package")
  build_consumer("-DCMAKE_PREFIX_PATH=${PREFIX}" "-DEXPECTED_ROOT=${PREFIX}")

elseif(CASE STREQUAL "pkg_config")
  find_program(pkg_config NAMES pkg-config pkgconf REQUIRED)
  file(GLOB_RECURSE pc "${PREFIX}/freqsynth.pc")
  cmake_path(GET pc PARENT_PATH pc_dir)
  cmake_path(GET pc_dir PARENT_PATH lib_dir)
  set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
  set(ENV{LD_LIBRARY_PATH} "${lib_dir}")
  execute_process(COMMAND "${pkg_config}" --cflags --libs "freqsynth = ${VERSION}"
    OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  file(GLOB sources "${CMAKE_CURRENT_LIST_DIR}/consumer/*.cpp")
  run("${CXX}" -std=c++20 ${sources} ${flags} -o "${scratch}/consumer")
  expect_version("${scratch}/consumer")

elseif(CASE STREQUAL "build_tree")
  build_consumer("-Dfreqsynth_DIR=${BUILD_DIR}" "-DEXPECTED_ROOT=${BUILD_DIR}")

elseif(CASE STREQUAL "add_subdirectory")
  build_consumer("-DFREQSYNTH_SOURCE=${SOURCE_DIR}")

elseif(CASE STREQUAL "shared")
  set(CONFIG Debug)
  configure("${SOURCE_DIR}" "${scratch}/build" -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Debug
    -DFREQSYNTH_BUILD_TESTS=OFF -DFREQSYNTH_BUILD_EXAMPLES=OFF -DFREQSYNTH_BUILD_BENCHMARKS=OFF)
  run("${CMAKE_COMMAND}" --build "${scratch}/build" --config Debug)
  install_moved("${scratch}/build" "${scratch}/prefix")
  file(GLOB_RECURSE library "${scratch}/prefix/*/libfreqsynth.so.${VERSION}")
  if(NOT library)
    message(FATAL_ERROR "no shared library of version ${VERSION} was installed")
  endif()
  build_consumer("-DCMAKE_PREFIX_PATH=${scratch}/prefix" "-DEXPECTED_ROOT=${scratch}/prefix")

else()
  message(FATAL_ERROR "unknown case ${CASE}")
endif()
