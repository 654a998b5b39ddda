# SPDX-License-Identifier: MIT
# Fails unless the ```${LANGUAGE} blocks of README (or those of LANGUAGE) are the files EXAMPLES of FOLDER, one each and in this
# order, but for trailing newlines and the line with the licence.
#   cmake -DREADME=README.md -DFOLDER=examples -DEXAMPLES=a.cpp,b.cpp -P check_readme.cmake
cmake_minimum_required(VERSION 3.25)

file(READ "${README}" rest)
set(rest "\n${rest}")
if(NOT LANGUAGE)
  set(LANGUAGE cpp)
endif()
set(fence "\n```${LANGUAGE}\n")
string(LENGTH "${fence}" length)

string(REPLACE "," ";" EXAMPLES "${EXAMPLES}")
foreach(file IN LISTS EXAMPLES)
  string(FIND "${rest}" "${fence}" begin)
  if(begin EQUAL -1)
    message(FATAL_ERROR "${README} has no ```${LANGUAGE} block for ${file}")
  endif()
  math(EXPR begin "${begin} + ${length}")
  string(SUBSTRING "${rest}" ${begin} -1 rest)
  string(FIND "${rest}" "\n```" end)
  if(end EQUAL -1)
    message(FATAL_ERROR "${README}: the ```${LANGUAGE} block for ${file} does not end")
  endif()
  string(SUBSTRING "${rest}" 0 ${end} block)
  string(SUBSTRING "${rest}" ${end} -1 rest)

  file(READ "${FOLDER}/${file}" example)
  string(REGEX REPLACE "^(//|/[*]) SPDX-License-Identifier: [^\n]*\n" "" example "${example}")
  string(REGEX REPLACE "\n+$" "" block "${block}")
  string(REGEX REPLACE "\n+$" "" example "${example}")
  if(NOT block STREQUAL example)
    message(FATAL_ERROR "${README}: the ```${LANGUAGE} block for ${file} differs from the file")
  endif()
endforeach()

string(FIND "${rest}" "${fence}" begin)
if(NOT begin EQUAL -1)
  message(FATAL_ERROR "${README} has a ```${LANGUAGE} block that is no example: no test compiles it")
endif()
