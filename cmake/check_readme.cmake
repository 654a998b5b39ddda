# Fails unless the first ```cpp block of README equals the file EXAMPLE, trailing newlines aside.
#   cmake -DREADME=README.md -DEXAMPLE=examples/hello.cpp -P check_readme.cmake
cmake_minimum_required(VERSION 3.25)

file(READ "${README}" readme)
file(READ "${EXAMPLE}" example)

set(fence "```cpp\n")
string(FIND "\n${readme}" "\n${fence}" begin)
if(begin EQUAL -1)
  message(FATAL_ERROR "${README} has no ```cpp block")
endif()
string(LENGTH "${fence}" length)
math(EXPR begin "${begin} + ${length}")
string(SUBSTRING "${readme}" ${begin} -1 block)
string(FIND "${block}" "\n```" end)
if(end EQUAL -1)
  message(FATAL_ERROR "${README}: the first ```cpp block does not end")
endif()
string(SUBSTRING "${block}" 0 ${end} block)

string(REGEX REPLACE "\n+$" "" block "${block}")
string(REGEX REPLACE "\n+$" "" example "${example}")
if(NOT block STREQUAL example)
  message(FATAL_ERROR "The first ```cpp block of ${README} differs from ${EXAMPLE}")
endif()
