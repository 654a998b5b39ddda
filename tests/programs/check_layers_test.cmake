# SPDX-License-Identifier: MIT
# Feeds check_layers.cmake a good tree and trees with one fault each.
#   cmake -DCHECK=check_layers.cmake -DWORK_DIR=scratch -P check_layers_test.cmake
cmake_minimum_required(VERSION 3.25)

set(tree "${WORK_DIR}/include")
set(table "${WORK_DIR}/layers.cmake")

function(write_header name)
  list(JOIN ARGN "\n" text)
  file(WRITE "${tree}/freqsynth/${name}" "#pragma once\n${text}\n")
endfunction()

function(start_tree)
  file(REMOVE_RECURSE "${WORK_DIR}")
  file(WRITE "${table}" [[set(FREQSYNTH_LAYERS "low.h|the lowest|1" "left.h|left|" "part/right.h|right|2, 3" "top.h|all|")]])
  write_header(low.h "#include <cmath>")
  write_header(left.h "#include \"freqsynth/low.h\"")
  write_header(part/right.h "#include \"freqsynth/low.h\"")
  write_header(top.h "#include \"freqsynth/part/right.h\"" "#include \"freqsynth/left.h\"")
endfunction()

# An empty `expected` means that the check must pass.
function(expect expected)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" "-DINCLUDE_DIR=${tree}" "-DTABLE=${table}" ${ARGN} -P "${CHECK}"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(expected STREQUAL "" AND NOT result EQUAL 0)
    message(SEND_ERROR "the good tree was refused: ${output}")
  elseif(NOT expected STREQUAL "")
    string(FIND "${output}" "${expected}" position)
    if(result EQUAL 0 OR position EQUAL -1)
      message(SEND_ERROR "expected a failure with \"${expected}\", got ${result}: ${output}")
    endif()
  endif()
endfunction()

start_tree()
expect("")

start_tree()
write_header(stray.h)
expect("stray.h: not in the layer table")

start_tree()
file(REMOVE "${tree}/freqsynth/left.h")
expect("left.h: in the layer table but not in the tree")

start_tree()
write_header(low.h "  #  include \"freqsynth/top.h\"")
expect("low.h: may not include top.h, which is not above it")

start_tree()
write_header(left.h "#include \"freqsynth/part/right.h\"")
expect("left.h: may not include part/right.h, which is not above it")

start_tree()
write_header(left.inl "#include \"freqsynth/left.h\"" "#include \"freqsynth/low.h\"")
write_header(left.h "#include \"freqsynth/left.inl\"")
expect("")

start_tree()
write_header(low.inl "#include \"freqsynth/left.h\"")
expect("low.inl: may not include left.h, which is not above it")

start_tree()
write_header(part/right.h "#include \"freqsynth/left.inl\"")
expect("")

start_tree()
write_header(left.h "#include \"freqsynth/part/right.inl\"")
expect("left.h: may not include part/right.inl, which is not above it")

start_tree()
write_header(left_one.inl "#include \"freqsynth/low.h\"")
write_header(left_two.inl "#include \"freqsynth/left_one.inl\"")
write_header(left.inl "#include \"freqsynth/left_two.inl\"")
expect("")

start_tree()
write_header(left_one.inl "#include \"freqsynth/part/right.h\"")
expect("left_one.inl: may not include part/right.h, which is not above it")

start_tree()
write_header(left_one.inl)
write_header(low.inl "#include \"freqsynth/left_one.inl\"")
expect("low.inl: may not include left_one.inl, which is not above it")

start_tree()
write_header(stray_one.inl)
expect("stray_one.inl: not in the layer table")

start_tree()
write_header(left.h "#include \"freqsynth/absent.h\"")
expect("includes absent.h, which is not in the layer table")

start_tree()
write_header(left.h "#include <freqsynth/low.h>")
expect("<freqsynth/low.h> must be written \"freqsynth/low.h\"")

start_tree()
write_header(left.h "#include \"low.h\"")
expect("left.h: include as \"freqsynth/...\"")

foreach(name IN ITEMS iostream thread functional regex)
  start_tree()
  write_header(part/right.h "#include <${name}>")
  expect("part/right.h: heavy header <${name}>")
endforeach()

# The table of the README.
set(readme "${WORK_DIR}/README.md")
start_tree()
file(WRITE "${readme}" "Before\n\n| header | what it does | paper |\n|---|---|---|\n| `low.h` | old | |\n\nAfter\n")
expect("its table of headers is not the layer table" "-DREADME=${readme}")
expect("" "-DREADME=${readme}" -DFIX=ON)
expect("" "-DREADME=${readme}")
file(READ "${readme}" text)
if(NOT text MATCHES "^Before\n\n.*[|] `part/right.h` [|] right [|] 2, 3 [|]\n.*\n\nAfter\n$")
  message(SEND_ERROR "the README was not repaired: ${text}")
endif()
