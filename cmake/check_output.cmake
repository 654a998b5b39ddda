# SPDX-License-Identifier: MIT
# Fails unless DOCUMENT shows what PROGRAM prints, or with -DFIX=ON writes it there. It is the block
# ``` after a line "<!-- NAME prints -->", NAME being that of the program's file.
#   cmake -DPROGRAM=build/noisy -DDOCUMENT=docs/settings.md [-DFIX=ON] -P check_output.cmake
cmake_minimum_required(VERSION 3.25)

execute_process(COMMAND "${PROGRAM}" OUTPUT_VARIABLE printed COMMAND_ERROR_IS_FATAL ANY)
cmake_path(GET PROGRAM STEM name)
file(READ "${DOCUMENT}" text)

set(begin "<!-- ${name} prints -->\n```\n")
string(FIND "${text}" "${begin}" place)
if(place EQUAL -1)
  message(FATAL_ERROR "${DOCUMENT} has no block ``` after a line <!-- ${name} prints -->")
endif()
string(LENGTH "${begin}" length)
math(EXPR place "${place} + ${length}")
string(SUBSTRING "${text}" 0 ${place} before)
string(SUBSTRING "${text}" ${place} -1 after)
string(FIND "${after}" "```" end)
string(SUBSTRING "${after}" 0 ${end} shown)
string(SUBSTRING "${after}" ${end} -1 after)

if(shown STREQUAL printed)
  return()
endif()
if(FIX)
  file(WRITE "${DOCUMENT}" "${before}${printed}${after}")
else()
  message(FATAL_ERROR "${DOCUMENT} shows of ${name}\n${shown}but it prints\n${printed}"
    "Repair with: cmake -DPROGRAM=${PROGRAM} -DDOCUMENT=${DOCUMENT} -DFIX=ON "
    "-P ${CMAKE_CURRENT_LIST_FILE}")
endif()
