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
  configure("${CMAKE_CURRENT_LIST_DIR}/${CONSUMER}" "${SCRATCH}/${CONSUMER}"
    "-DCMAKE_BUILD_TYPE=${CONFIG}" "-DVERSION=${VERSION}" ${ARGN})
  run("${CMAKE_COMMAND}" --build "${SCRATCH}/${CONSUMER}" --config "${CONFIG}")
  find_program(consumer consumer NO_CACHE REQUIRED NO_DEFAULT_PATH
    PATHS "${SCRATCH}/${CONSUMER}" "${SCRATCH}/${CONSUMER}/${CONFIG}")
  expect_version("${consumer}")
endfunction()

function(install_moved build prefix)
  run("${CMAKE_COMMAND}" --install "${build}" --config "${CONFIG}" --prefix "${SCRATCH}/first")
  file(REMOVE_RECURSE "${prefix}")
  file(RENAME "${SCRATCH}/first" "${prefix}")
endfunction()

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

elseif(CASE STREQUAL "build_tree")
  build_consumer("-Dfreqsynth_DIR=${BUILD_DIR}" "-DEXPECTED_ROOT=${BUILD_DIR}")

elseif(CASE STREQUAL "add_subdirectory")
  build_consumer("-DFREQSYNTH_SOURCE=${SOURCE_DIR}")

elseif(CASE STREQUAL "shared")
  set(CONFIG Debug)
  configure("${SOURCE_DIR}" "${SCRATCH}/build" -DBUILD_SHARED_LIBS=ON -DCMAKE_BUILD_TYPE=Debug
    -DFREQSYNTH_BUILD_TESTS=OFF -DFREQSYNTH_BUILD_EXAMPLES=OFF -DFREQSYNTH_BUILD_BENCHMARKS=OFF)
  run("${CMAKE_COMMAND}" --build "${SCRATCH}/build" --config Debug)
  install_moved("${SCRATCH}/build" "${SCRATCH}/prefix")
  file(GLOB_RECURSE library "${SCRATCH}/prefix/*/libfreqsynth.so.${VERSION}")
  if(NOT library)
    message(FATAL_ERROR "no shared library of version ${VERSION} was installed")
  endif()
  build_consumer("-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix" "-DEXPECTED_ROOT=${SCRATCH}/prefix")
  file(GLOB_RECURSE library "${SCRATCH}/prefix/*/libfreqsynth_jpeg.so.${VERSION}")
  if(library)
    set(CONSUMER jpeg_consumer)
    build_consumer("-DCMAKE_PREFIX_PATH=${SCRATCH}/prefix")
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
