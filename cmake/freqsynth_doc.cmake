# SPDX-License-Identifier: MIT
# The target freqsynth_doc: the API reference by Doxygen, in docs/api of the build folder. A comment
# that is missing or leads nowhere fails it.
if(PROJECT_IS_TOP_LEVEL)
  set(doc_default AUTO)
else()
  set(doc_default OFF)
endif()
set(FREQSYNTH_DOC ${doc_default} CACHE STRING
  "Add the target freqsynth_doc: ON, OFF, or AUTO: when doxygen is found")
set_property(CACHE FREQSYNTH_DOC PROPERTY STRINGS AUTO ON OFF)

if(NOT FREQSYNTH_DOC)
  return()
endif()
find_program(FREQSYNTH_DOXYGEN doxygen)
mark_as_advanced(FREQSYNTH_DOXYGEN)
if(NOT FREQSYNTH_DOXYGEN)
  if(NOT FREQSYNTH_DOC STREQUAL "AUTO")
    message(FATAL_ERROR "FREQSYNTH_DOC is ${FREQSYNTH_DOC}, but doxygen is not found")
  endif()
  message(STATUS "doxygen not found: without freqsynth_doc")
  return()
endif()

set(FREQSYNTH_DOC_DIR "${PROJECT_BINARY_DIR}/docs/api")
file(MAKE_DIRECTORY "${FREQSYNTH_DOC_DIR}")
configure_file(docs/api/Doxyfile.in "${PROJECT_BINARY_DIR}/Doxyfile" @ONLY)
add_custom_target(freqsynth_doc
  COMMAND "${FREQSYNTH_DOXYGEN}" "${PROJECT_BINARY_DIR}/Doxyfile"
  COMMENT "API reference in ${FREQSYNTH_DOC_DIR}/html"
  VERBATIM)
