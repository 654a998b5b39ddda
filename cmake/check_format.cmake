# SPDX-License-Identifier: MIT
# Checks the layout of the C++ sources below ROOT, or with -DFIX=ON repairs it.
#   cmake [-DROOT=.] [-DFIX=ON] -P cmake/check_format.cmake
cmake_minimum_required(VERSION 3.25)

if(NOT ROOT)
  cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH ROOT)
endif()

# Other versions lay out some constructs differently.
find_program(CLANG_FORMAT NAMES clang-format-14 clang-format)
if(CLANG_FORMAT)
  execute_process(COMMAND "${CLANG_FORMAT}" --version OUTPUT_VARIABLE version)
endif()
if(NOT version MATCHES "version 14\\.")
  message("clang-format 14 not found: the layout is not checked")
  return()
endif()

set(files "")
foreach(folder IN ITEMS include src tests examples benchmarks)
  file(GLOB_RECURSE found RELATIVE "${ROOT}" "${ROOT}/${folder}/*.h" "${ROOT}/${folder}/*.inl"
    "${ROOT}/${folder}/*.cpp")
  list(APPEND files ${found})
endforeach()
if(FIX)
  execute_process(COMMAND "${CLANG_FORMAT}" -i ${files} WORKING_DIRECTORY "${ROOT}"
    COMMAND_ERROR_IS_FATAL ANY)
  return()
endif()

# All in one process: to start it takes longer than a file.
execute_process(COMMAND "${CLANG_FORMAT}" --dry-run --Werror ${files} WORKING_DIRECTORY "${ROOT}"
  RESULT_VARIABLE result ERROR_VARIABLE errors)
set(faults "")
if(NOT result EQUAL 0)
  string(REGEX MATCHALL "[^\n]+:[0-9]+:[0-9]+: error" lines "${errors}")
  set(known "")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE ":[0-9]+: error$" ":" line "${line}")
    string(REGEX REPLACE ":[0-9]+:$" "" file "${line}")
    if(NOT file IN_LIST known)
      list(APPEND known "${file}")
      string(APPEND faults "  ${line}\n")
    endif()
  endforeach()
  if(NOT faults)
    set(faults "${errors}")
  endif()
endif()
if(faults)
  message(FATAL_ERROR "Not laid out by .clang-format:\n${faults}"
    "Repair with: cmake -DFIX=ON -P cmake/check_format.cmake")
endif()
