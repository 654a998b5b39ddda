# SPDX-License-Identifier: MIT
# gcc, clang, and those that take their options.
set(freqsynth_gnu_like FALSE)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang" AND NOT CMAKE_CXX_COMPILER_FRONTEND_VARIANT STREQUAL "MSVC")
  set(freqsynth_gnu_like TRUE)
endif()

# Settings of the project's own targets. All PRIVATE: a user's target that links freqsynth must
# not inherit warnings, sanitizers or an instruction set.
function(freqsynth_own_target target)
  set_target_properties(${target} PROPERTIES
    CXX_EXTENSIONS OFF
    COMPILE_WARNING_AS_ERROR "${FREQSYNTH_WARNINGS_AS_ERRORS}")
  if(freqsynth_gnu_like)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
  endif()
  if(FREQSYNTH_NATIVE)
    target_compile_options(${target} PRIVATE -march=native)
  endif()
  if(FREQSYNTH_SANITIZE)
    list(JOIN FREQSYNTH_SANITIZE "," sanitizers)
    target_compile_options(${target} PRIVATE
      -fsanitize=${sanitizers} -fno-sanitize-recover=all -fno-omit-frame-pointer)
    target_link_options(${target} PRIVATE -fsanitize=${sanitizers})
  endif()
endfunction()

# With FREQSYNTH_FUZZ: clang's fuzzers are told which branches of this target are taken.
function(freqsynth_fuzzed target)
  if(FREQSYNTH_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
    target_link_options(${target} PRIVATE -fsanitize=fuzzer-no-link)
  endif()
endfunction()
