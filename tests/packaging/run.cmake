# SPDX-License-Identifier: MIT
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
      "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_C_COMPILER=${CC}" ${ARGN})
endfunction()

# Compiles the consumer in C99 with what pkg-config says, and runs it.
function(build_c_consumer prefix)
  find_program(pkg_config NAMES pkg-config pkgconf REQUIRED)
  file(GLOB_RECURSE pc "${prefix}/freqsynth.pc")
  cmake_path(GET pc PARENT_PATH pc_dir)
  cmake_path(GET pc_dir PARENT_PATH lib_dir)
  set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
  set(ENV{LD_LIBRARY_PATH} "${lib_dir}")
  execute_process(COMMAND "${pkg_config}" --cflags --libs ${ARGN} "freqsynth = ${VERSION}"
    OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run("${CC}" -std=c99 -pedantic -Wall -Wextra -Werror
      "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/c_consumer/main.c" ${flags} -o "${SCRATCH}/c_consumer_pc")
  expect_version("${SCRATCH}/c_consumer_pc")
endfunction()

function(build_consumer)
  configure("${CMAKE_CURRENT_LIST_DIR}/${CONSUMER}" "${SCRATCH}/${CONSUMER}"
    "-DCMAKE_BUILD_TYPE=${CONFIG}" "-DVERSION=${VERSION}" ${ARGN})
  run("${CMAKE_COMMAND}" --build "${SCRATCH}/${CONSUMER}" --config "${CONFIG}")
  find_program(consumer consumer NO_CACHE REQUIRED NO_DEFAULT_PATH
    PATHS "${SCRATCH}/${CONSUMER}" "${SCRATCH}/${CONSUMER}/${CONFIG}")
  expect_version("${consumer}")
endfunction()

function(install_moved build prefix)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" --install "${build}" --config "${CONFIG}"
      --prefix "${SCRATCH}/first"
    OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
  file(REMOVE_RECURSE "${prefix}")
  file(RENAME "${SCRATCH}/first" "${prefix}")
endfunction()

# Names of symbols as the linker sees them: list_symbols(variable options of nm, file)
function(list_symbols variable)
  execute_process(COMMAND "${NM}" ${ARGN} OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  # Lines are "address type name" or "type name".
  string(REGEX REPLACE "[^\n]* ([^ \n]+)\n" "\\1;" output "${output}")
  list(FILTER output INCLUDE REGEX "^_Z|^[A-Za-z_]")
  set(${variable} "${output}" PARENT_SCOPE)
endfunction()

# Configures freqsynth itself, which must end with that code; sets `output` and `errors`.
macro(configure_freqsynth code)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${SOURCE_DIR}" -B "${SCRATCH}/build" -G "${GENERATOR}"
      "-DCMAKE_CXX_COMPILER=${CXX}" ${ARGN}
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE errors COMMAND_ECHO STDOUT)
  if(NOT result EQUAL ${code})
    message(FATAL_ERROR "configured with ${result}: ${output}${errors}")
  endif()
endmacro()

file(REMOVE_RECURSE "${SCRATCH}")
file(MAKE_DIRECTORY "${SCRATCH}")

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
  set(package freqsynth)
  if(CONSUMER STREQUAL "jpeg_consumer")
    set(package freqsynth-jpeg)
  endif()
  file(GLOB_RECURSE pc "${PREFIX}/${package}.pc")
  cmake_path(GET pc PARENT_PATH pc_dir)
  cmake_path(GET pc_dir PARENT_PATH lib_dir)
  set(ENV{PKG_CONFIG_PATH} "${pc_dir}")
  set(ENV{LD_LIBRARY_PATH} "${lib_dir}")
  execute_process(COMMAND "${pkg_config}" --cflags --libs "${package} = ${VERSION}"
    OUTPUT_VARIABLE flags COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  file(GLOB sources "${CMAKE_CURRENT_LIST_DIR}/${CONSUMER}/*.cpp")
  run("${CXX}" -std=c++20 ${sources} ${flags} -o "${SCRATCH}/consumer")
  expect_version("${SCRATCH}/consumer")

elseif(CASE STREQUAL "pkg_config_c")
  # A static library: its own libraries, the C++ one among them, are named with --static.
  build_c_consumer("${PREFIX}" --static)

elseif(CASE STREQUAL "build_tree")
  build_consumer("-Dfreqsynth_DIR=${BUILD_DIR}" "-DEXPECTED_ROOT=${BUILD_DIR}")

elseif(CASE STREQUAL "add_subdirectory")
  set(CONFIG Debug)  # the quickest to build
  build_consumer("-DFREQSYNTH_SOURCE=${SOURCE_DIR}")

elseif(CASE STREQUAL "shared")
  # By the preset for those who install the library alone.
  set(CONFIG Debug)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" --preset library -B "${SCRATCH}/build" -G "${GENERATOR}"
      "-DCMAKE_CXX_COMPILER=${CXX}" -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Debug
    WORKING_DIRECTORY "${SOURCE_DIR}" COMMAND_ERROR_IS_FATAL ANY)
  run("${CMAKE_COMMAND}" --build "${SCRATCH}/build" --config Debug)
  install_moved("${SCRATCH}/build" "${SCRATCH}/prefix")
  set(shown "")
  set(libraries "")
  foreach(name IN ITEMS freqsynth freqsynth_jpeg)
    file(GLOB_RECURSE library "${SCRATCH}/prefix/*/lib${name}.so.${VERSION}")
    if(NOT library AND name STREQUAL "freqsynth")
      message(FATAL_ERROR "no shared library of version ${VERSION} was installed")
    elseif(library)
      list_symbols(symbols -D --defined-only "${library}")
      list(APPEND shown ${symbols})
      list(APPEND libraries ${name})
    endif()
  endforeach()

  # Shown is namespace freqsynth, its type information and tables, the C interface, and nothing
  # else.
  set(foreign "${shown}")
  list(FILTER foreign EXCLUDE REGEX "^_Z(T[ISVT])?NK?9freqsynth|^freqsynth_")
  if(foreign)
    list(JOIN foreign "\n  " foreign)
    message(SEND_ERROR "the shared library shows\n  ${foreign}")
  endif()
  # All that is declared for users is shown: functions of the static library outside `detail`.
  foreach(name IN LISTS libraries)
    file(GLOB_RECURSE library "${PREFIX}/*/lib${name}.a")
    if(NOT library)
      message(FATAL_ERROR "no static library ${name} in ${PREFIX}")
    endif()
    execute_process(COMMAND "${NM}" --defined-only "${library}" OUTPUT_VARIABLE output
      COMMAND_ERROR_IS_FATAL ANY)
    string(REGEX MATCHALL " T (_ZNK?9freqsynth|freqsynth_)[^\n]+" functions "${output}")
    list(TRANSFORM functions REPLACE "^ T " "")
    list(FILTER functions EXCLUDE REGEX "^_ZNK?9freqsynth6detail")
    list(FILTER functions EXCLUDE REGEX "C2E|D2E|[.]")  # twins of C1, D1; versions of a kernel
    if(NOT functions)
      message(FATAL_ERROR "no functions in ${library}")
    endif()
    list(REMOVE_ITEM functions ${shown})
    if(functions)
      list(JOIN functions "\n  " functions)
      message(SEND_ERROR "without FREQSYNTH_API:\n  ${functions}")
    endif()
  endforeach()
  # What the programs of this build take from the library is shown.
  file(GLOB_RECURSE objects "${BUILD_DIR}/examples/*.o" "${BUILD_DIR}/tests/*recorded_results*.o")
  foreach(object IN LISTS objects)
    list_symbols(needed -u "${object}")
    list(FILTER needed INCLUDE REGEX "^_Z(T[ISVT])?NK?9freqsynth")
    list(REMOVE_ITEM needed ${shown})
    if(needed)
      list(JOIN needed "\n  " needed)
      message(SEND_ERROR "${object} needs what is hidden:\n  ${needed}")
    endif()
  endforeach()

  build_consumer("-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix" "-DEXPECTED_ROOT=${SCRATCH}/prefix")
  set(CONSUMER c_consumer)
  build_consumer("-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix")
  build_c_consumer("${SCRATCH}/prefix")  # nothing but the library
  if("freqsynth_jpeg" IN_LIST libraries)
    set(CONSUMER jpeg_consumer)
    build_consumer("-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix")
  endif()

elseif(CASE STREQUAL "plug_in")
  # The static library, whose code does not know where it will lie.
  build_consumer("-DCMAKE_PREFIX_PATH=${PREFIX}")
  list_symbols(symbols -D --defined-only "${SCRATCH}/plug_in/plug_in.so")
  list(FILTER symbols INCLUDE REGEX "freqsynth")
  if(symbols)
    message(SEND_ERROR "the plug-in shows the library that it was made with: ${symbols}")
  endif()

elseif(CASE STREQUAL "nothing_else_there")
  # As on a machine that has a compiler and CMake. Each part is left out, and that is said ...
  set(hidden -DCMAKE_DISABLE_FIND_PACKAGE_GTest=ON -DCMAKE_DISABLE_FIND_PACKAGE_benchmark=ON
    -DCMAKE_DISABLE_FIND_PACKAGE_PkgConfig=ON -DCMAKE_DISABLE_FIND_PACKAGE_JPEG=ON)
  configure_freqsynth("0" ${hidden})
  foreach(word IN ITEMS "GoogleTest [^\n]*not found[^\n]*: without the tests"
                        "OpenImageIO not found[^\n]*: without the examples"
                        "Google Benchmark not found: without the benchmarks"
                        "libjpeg not found: without freqsynth::jpeg")
    if(NOT output MATCHES "-- ${word}\n")
      message(SEND_ERROR "expected \"${word}\" in: ${output}")
    endif()
  endforeach()
  # ... but not when it is wanted.
  foreach(part IN ITEMS "TESTS;GoogleTest" "EXAMPLES;OpenImageIO" "BENCHMARKS;Google Benchmark")
    list(GET part 0 name)
    list(GET part 1 needs)
    configure_freqsynth("1" ${hidden} -DFREQSYNTH_BUILD_${name}=ON)
    if(NOT errors MATCHES "FREQSYNTH_BUILD_${name} is ON, but: ${needs}")
      message(SEND_ERROR "expected a refusal for want of ${needs}: ${errors}")
    endif()
    file(REMOVE_RECURSE "${SCRATCH}/build")
  endforeach()
  configure_freqsynth("1" -DFREQSYNTH_BUILD_TESTS=ON -DBUILD_SHARED_LIBS=ON)
  if(NOT errors MATCHES "FREQSYNTH_BUILD_TESTS is ON, but: a shared library hides")
    message(SEND_ERROR "expected a refusal of tests with a shared library: ${errors}")
  endif()

elseif(CASE STREQUAL "one_file")
  # Exactly what a user types.
  separate_arguments(flags UNIX_COMMAND "${FLAGS}")
  run("${CXX}" -std=c++20 ${flags} "-I${SOURCE_DIR}/include" "${SOURCE_DIR}/${FILE}"
      -o "${SCRATCH}/program")
  execute_process(COMMAND "${SCRATCH}/program" WORKING_DIRECTORY "${SCRATCH}"
    COMMAND_ERROR_IS_FATAL ANY)
  if(FILE MATCHES "single_file")
    file(READ "${SCRATCH}/single_file.pgm" start LIMIT 15)
    file(SIZE "${SCRATCH}/single_file.pgm" size)
    if(NOT start STREQUAL "P5 256 256 255\n" OR NOT size EQUAL 65551)
      message(FATAL_ERROR "single_file.pgm has ${size} bytes and begins ${start}")
    endif()
  endif()

elseif(CASE STREQUAL "without_libjpeg")
  # The library is built without the component, and says so.
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${SOURCE_DIR}" -B "${SCRATCH}/build" -G "${GENERATOR}"
      "-DCMAKE_CXX_COMPILER=${CXX}" -DCMAKE_DISABLE_FIND_PACKAGE_JPEG=ON
      -DFREQSYNTH_BUILD_TESTS=OFF -DFREQSYNTH_BUILD_EXAMPLES=OFF -DFREQSYNTH_BUILD_BENCHMARKS=OFF
    OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "libjpeg not found: without freqsynth::jpeg")
    message(FATAL_ERROR "no word on the missing component: ${output}")
  endif()
  # The installed core needs no libjpeg, the component does.
  set(CONSUMER consumer)
  build_consumer("-DCMAKE_PREFIX_PATH=${PREFIX}" "-DEXPECTED_ROOT=${PREFIX}"
    -DCMAKE_DISABLE_FIND_PACKAGE_JPEG=ON)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${CMAKE_CURRENT_LIST_DIR}/jpeg_consumer"
      -B "${SCRATCH}/refused" -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${CXX}"
      "-DVERSION=${VERSION}" "-DCMAKE_PREFIX_PATH=${PREFIX}" -DCMAKE_DISABLE_FIND_PACKAGE_JPEG=ON
    RESULT_VARIABLE result ERROR_VARIABLE errors)
  if(result EQUAL 0 OR NOT errors MATCHES "jpeg needs libjpeg")
    message(FATAL_ERROR "expected a refusal for want of libjpeg, got ${result}: ${errors}")
  endif()

else()
  message(FATAL_ERROR "unknown case ${CASE}")
endif()
