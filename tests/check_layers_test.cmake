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
  file(WRITE "${table}" [[set(FREQSYNTH_LAYERS "0 low.h" "1 left.h" "1 detail/right.h" "10 top.h")]])
  write_header(low.h "#include <cmath>")
  write_header(left.h "#include \"freqsynth/low.h\"")
  write_header(detail/right.h "#include \"freqsynth/low.h\"")
  write_header(top.h "#include \"freqsynth/detail/right.h\"" "#include \"freqsynth/left.h\"")
endfunction()

# An empty `expected` means that the check must pass.
function(expect expected)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" "-DINCLUDE_DIR=${tree}" "-DTABLE=${table}" -P "${CHECK}"
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
expect("low.h (layer 0): may not include top.h (layer 10)")

start_tree()
write_header(left.h "#include \"freqsynth/detail/right.h\"")
expect("left.h (layer 1): may not include detail/right.h (layer 1)")

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
  write_header(detail/right.h "#include <${name}>")
  expect("detail/right.h: heavy header <${name}>")
endforeach()
