# SPDX-License-Identifier: MIT
# Settings of the libraries that are installed.
function(freqsynth_library target)
  set_target_properties(${target} PROPERTIES
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    # A static library too ends in plug-ins and Python modules.
    POSITION_INDEPENDENT_CODE ON
    # Shown is what FREQSYNTH_API marks.
    CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON
    VERIFY_INTERFACE_HEADER_SETS ${PROJECT_IS_TOP_LEVEL}
    # Each x.inl is compiled alone already, by src/x.cpp.
    INTERFACE_HEADER_SETS_TO_VERIFY HEADERS)
  if(freqsynth_gnu_like)
    # Kernels are chosen at run time. Contraction to fused multiply-add would make their bits depend
    # on the instruction set.
    target_compile_options(${target} PRIVATE -ffp-contract=off)
  endif()

  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY")
    target_compile_definitions(${target} PUBLIC FREQSYNTH_SHARED PRIVATE FREQSYNTH_BUILDING)
    if(CMAKE_EXECUTABLE_FORMAT STREQUAL "ELF")
      # What templates of the standard library leave behind is visible, whatever the compiler is
      # told: namespace std says so itself.
      set(script "${PROJECT_SOURCE_DIR}/cmake/freqsynth.map")
      target_link_options(${target} PRIVATE "LINKER:--version-script=${script}")
      set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS "${script}")
    endif()
  endif()

  freqsynth_own_target(${target})
  freqsynth_fuzzed(${target})
endfunction()
