# SPDX-License-Identifier: MIT
# Compiles each case of refused.cpp and looks for its sentence in what the compiler says.
#   cmake -DCOMPILER=g++ -DINCLUDE_DIR=include -P check_refused.cmake
cmake_minimum_required(VERSION 3.25)

set(source "${CMAKE_CURRENT_LIST_DIR}/refused.cpp")
file(STRINGS "${source}" cases REGEX "CASE == ")
list(LENGTH cases count)
if(count LESS 6)
  message(FATAL_ERROR "${source} has only ${count} cases")
endif()
foreach(case IN LISTS cases)
  if(NOT case MATCHES "CASE == ([0-9]+) +// (.+)$")
    message(FATAL_ERROR "cannot read: ${case}")
  endif()
  set(number "${CMAKE_MATCH_1}")
  set(sentence "${CMAKE_MATCH_2}")
  execute_process(
    COMMAND "${COMPILER}" -std=c++20 -fsyntax-only "-I${INCLUDE_DIR}" -DCASE=${number} "${source}"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(sentence STREQUAL "compiles" AND NOT result EQUAL 0)
    message(SEND_ERROR "case ${number} must compile: ${output}")
  elseif(NOT sentence STREQUAL "compiles")
    # A sentence may be broken into lines.
    string(REGEX REPLACE "[ \n]+" " " output "${output}")
    string(FIND "${output}" "${sentence}" place)
    if(result EQUAL 0 OR place EQUAL -1)
      message(SEND_ERROR "case ${number} must be refused with \"${sentence}\", but: ${output}")
    endif()
  endif()
endforeach()
