# SPDX-License-Identifier: MIT
include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/freqsynth")

install(TARGETS freqsynth freqsynth_header_only EXPORT freqsynthTargets
  FILE_SET HEADERS FILE_SET definitions)
install(EXPORT freqsynthTargets NAMESPACE freqsynth:: DESTINATION "${package_dir}")
# The build tree is a package too: -Dfreqsynth_DIR=<build>.
export(EXPORT freqsynthTargets NAMESPACE freqsynth::
  FILE "${PROJECT_BINARY_DIR}/freqsynthTargets.cmake")

# An export set of its own, for users of the core must not need libjpeg.
if(TARGET freqsynth_jpeg)
  install(TARGETS freqsynth_jpeg EXPORT freqsynthJpegTargets FILE_SET HEADERS)
  install(EXPORT freqsynthJpegTargets NAMESPACE freqsynth:: DESTINATION "${package_dir}")
  export(EXPORT freqsynthJpegTargets NAMESPACE freqsynth::
    FILE "${PROJECT_BINARY_DIR}/freqsynthJpegTargets.cmake")
endif()

configure_package_config_file(cmake/freqsynthConfig.cmake.in
  "${PROJECT_BINARY_DIR}/freqsynthConfig.cmake" INSTALL_DESTINATION "${package_dir}")
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file("${PROJECT_BINARY_DIR}/freqsynthConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(FILES
  "${PROJECT_BINARY_DIR}/freqsynthConfig.cmake"
  "${PROJECT_BINARY_DIR}/freqsynthConfigVersion.cmake"
  DESTINATION "${package_dir}")

# Relative to the .pc file, so that an installed tree can be moved.
file(RELATIVE_PATH pc_prefix
  "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
file(RELATIVE_PATH pc_includedir
  "${CMAKE_INSTALL_PREFIX}" "${CMAKE_INSTALL_FULL_INCLUDEDIR}")
configure_file(cmake/freqsynth.pc.in "${PROJECT_BINARY_DIR}/freqsynth.pc" @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/freqsynth.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
if(TARGET freqsynth_jpeg)
  # A static library does not bring libjpeg itself.
  if(BUILD_SHARED_LIBS)
    set(pc_requires_public "")
    set(pc_requires_private "libjpeg")
  else()
    set(pc_requires_public ", libjpeg")
    set(pc_requires_private "")
  endif()
  configure_file(cmake/freqsynth-jpeg.pc.in "${PROJECT_BINARY_DIR}/freqsynth-jpeg.pc" @ONLY)
  install(FILES "${PROJECT_BINARY_DIR}/freqsynth-jpeg.pc"
    DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
endif()

install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}")
