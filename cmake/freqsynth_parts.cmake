# SPDX-License-Identifier: MIT
# What is built beside the library. Each part is ON, OFF, or AUTO: when what it needs is found.
# Afterwards FREQSYNTH_BUILD_<PART> is ON or OFF in this folder and those below; the cache keeps
# what the user said.
if(PROJECT_IS_TOP_LEVEL)
  set(part_default AUTO)
else()
  set(part_default OFF)
endif()
set(FREQSYNTH_BUILD_TESTS ${part_default} CACHE STRING "Build the tests (GoogleTest): AUTO, ON, OFF")
set(FREQSYNTH_BUILD_EXAMPLES ${part_default} CACHE STRING
  "Build the examples (OpenImageIO): AUTO, ON, OFF")
set(FREQSYNTH_BUILD_BENCHMARKS ${part_default} CACHE STRING
  "Build the benchmarks (Google Benchmark): AUTO, ON, OFF")
set_property(CACHE FREQSYNTH_BUILD_TESTS FREQSYNTH_BUILD_EXAMPLES FREQSYNTH_BUILD_BENCHMARKS
  PROPERTY STRINGS AUTO ON OFF)

# freqsynth_part(TESTS good "what is wrong"): says so, or refuses, unless the variable `good` is true.
macro(freqsynth_part name good wrong)
  string(TOLOWER "${name}" what)
  if(NOT FREQSYNTH_BUILD_${name})
    set(FREQSYNTH_BUILD_${name} OFF)
  elseif(${good})
    set(FREQSYNTH_BUILD_${name} ON)
  elseif(FREQSYNTH_BUILD_${name} STREQUAL "AUTO")
    message(STATUS "${wrong}: without the ${what}")
    set(FREQSYNTH_BUILD_${name} OFF)
  else()
    message(FATAL_ERROR "FREQSYNTH_BUILD_${name} is ${FREQSYNTH_BUILD_${name}}, but: ${wrong}")
  endif()
endmacro()

if(FREQSYNTH_BUILD_EXAMPLES)
  # Not find_package(OpenImageIO): on Debian 12 its exported target names a folder of OpenCV that
  # libopenimageio-dev does not bring.
  find_package(PkgConfig QUIET)
  if(PkgConfig_FOUND)
    pkg_check_modules(OIIO QUIET IMPORTED_TARGET OpenImageIO)
  endif()
endif()
freqsynth_part(EXAMPLES OIIO_FOUND "OpenImageIO not found (by pkg-config)")

if(FREQSYNTH_BUILD_BENCHMARKS)
  find_package(benchmark QUIET)
endif()
freqsynth_part(BENCHMARKS benchmark_FOUND "Google Benchmark not found")

if(FREQSYNTH_BUILD_TESTS)
  find_package(GTest QUIET)
endif()
if(GTest_FOUND AND TARGET GTest::gmock)
  set(gtest_found TRUE)
else()
  set(gtest_found FALSE)
endif()
freqsynth_part(TESTS gtest_found "GoogleTest (with GoogleMock) not found")
if(BUILD_SHARED_LIBS)
  set(library_is_open FALSE)
else()
  set(library_is_open TRUE)
endif()
freqsynth_part(TESTS library_is_open "a shared library hides the parts that the tests look at")
