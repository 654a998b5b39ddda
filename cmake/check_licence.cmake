# SPDX-License-Identifier: MIT
# Checks that each source, script and CMake file below ROOT says its licence in the first line, the
# one after "#!" where there is one, or with -DFIX=ON writes it there.
#   cmake [-DROOT=.] [-DFIX=ON] -P cmake/check_licence.cmake
cmake_minimum_required(VERSION 3.25)

if(NOT ROOT)
  cmake_path(GET CMAKE_CURRENT_LIST_DIR PARENT_PATH ROOT)
endif()
set(licence "SPDX-License-Identifier: MIT")

set(files "")
foreach(folder IN ITEMS .ci benchmarks cmake docs examples include src tests)
  file(GLOB_RECURSE found RELATIVE "${ROOT}" "${ROOT}/${folder}/*")
  list(APPEND files ${found})
endforeach()
list(APPEND files CMakeLists.txt)

set(checked 0)
set(faults "")
foreach(file IN LISTS files)
  # Scripts without an ending are told by their first two characters.
  file(READ "${ROOT}/${file}" head LIMIT 2 HEX)
  if(file MATCHES "\\.(h|inl|cpp)$")
    set(line "// ${licence}\n")
  elseif(head STREQUAL "2321" OR file MATCHES "\\.(sh|cmake|cmake\\.in|pc\\.in|py|awk)$"
         OR file MATCHES "(CMakeLists\\.txt|Doxyfile\\.in)$")
    set(line "# ${licence}\n")
  else()
    continue()
  endif()
  math(EXPR checked "${checked} + 1")

  # Not a list of lines: what CMake makes of semicolons and brackets would not come back.
  file(READ "${ROOT}/${file}" text)
  set(shebang "")
  if(head STREQUAL "2321")
    string(FIND "${text}" "\n" end)
    math(EXPR end "${end} + 1")
    string(SUBSTRING "${text}" 0 ${end} shebang)
    string(SUBSTRING "${text}" ${end} -1 text)
  endif()
  string(LENGTH "${line}" length)
  string(SUBSTRING "${text}" 0 ${length} first)
  if(first STREQUAL line)
    continue()
  elseif(FIX)
    file(WRITE "${ROOT}/${file}" "${shebang}${line}${text}")
  else()
    string(APPEND faults "  ${file}\n")
  endif()
endforeach()

if(checked EQUAL 0)
  message(FATAL_ERROR "no files below ${ROOT}")
endif()
if(faults)
  message(FATAL_ERROR "Without the line ${licence}:\n${faults}"
    "Repair with: cmake -DFIX=ON -P cmake/check_licence.cmake")
endif()
message(STATUS "${checked} files say their licence")
