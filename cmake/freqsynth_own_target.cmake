# Settings of the project's own targets. All PRIVATE: a user's target that links freqsynth must
# not inherit warnings, sanitizers or an instruction set.
function(freqsynth_own_target target)
  set_target_properties(${target} PROPERTIES
    CXX_EXTENSIONS OFF
    COMPILE_WARNING_AS_ERROR "${FREQSYNTH_WARNINGS_AS_ERRORS}")
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
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
