# SPDX-License-Identifier: MIT
# The component freqsynth::jpeg, the only part of the library that needs another one: libjpeg.
if(PROJECT_IS_TOP_LEVEL)
  set(jpeg_default AUTO)
else()
  set(jpeg_default OFF)
endif()
set(FREQSYNTH_JPEG ${jpeg_default} CACHE STRING
  "Build freqsynth::jpeg: ON, OFF, or AUTO: when libjpeg is found")
set_property(CACHE FREQSYNTH_JPEG PROPERTY STRINGS AUTO ON OFF)

if(FREQSYNTH_JPEG STREQUAL "AUTO")
  find_package(JPEG QUIET)
elseif(FREQSYNTH_JPEG)
  find_package(JPEG REQUIRED)
else()
  return()
endif()
if(NOT JPEG_FOUND)
  message(STATUS "libjpeg not found: without freqsynth::jpeg")
  return()
endif()

add_library(freqsynth_jpeg src/c/jpeg.cpp src/jpeg/jpeg.cpp src/jpeg/jpeg_file.cpp)
add_library(freqsynth::jpeg ALIAS freqsynth_jpeg)
target_sources(freqsynth_jpeg PUBLIC
  FILE_SET HEADERS BASE_DIRS include FILES
  include/freqsynth/c/jpeg.h include/freqsynth/jpeg/jpeg.h include/freqsynth/jpeg/jpeg_file.h)
target_include_directories(freqsynth_jpeg PRIVATE src)
target_include_directories(freqsynth_jpeg PRIVATE src)
target_link_libraries(freqsynth_jpeg PUBLIC freqsynth PRIVATE JPEG::JPEG)
set_target_properties(freqsynth_jpeg PROPERTIES EXPORT_NAME jpeg INSTALL_RPATH "$ORIGIN")
freqsynth_library(freqsynth_jpeg)
