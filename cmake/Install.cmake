# SPDX-License-Identifier: BSD-3-Clause
# What `cmake --install` puts in place: library, headers, limitclConfig.cmake and limitcl.pc. All of it can be moved afterwards.
include(CMakePackageConfigHelpers)

set(package_directory "${CMAKE_INSTALL_LIBDIR}/cmake/limitcl")
install(TARGETS limitcl EXPORT limitclTargets LIBRARY DESTINATION "${CMAKE_INSTALL_LIBDIR}")
install(FILES ${limitcl_public_headers} DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/limitcl")
install(FILES LICENSE DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(EXPORT limitclTargets NAMESPACE limitcl:: DESTINATION "${package_directory}")

configure_package_config_file(cmake/limitclConfig.cmake.in limitclConfig.cmake INSTALL_DESTINATION "${package_directory}")
write_basic_package_version_file(limitclConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/limitclConfig.cmake" "${PROJECT_BINARY_DIR}/limitclConfigVersion.cmake" DESTINATION "${package_directory}")

# The prefix is found from the .pc file's own place: one written here would be wrong after `cmake --install --prefix`.
file(RELATIVE_PATH LIMITCL_PC_UP "${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig" "${CMAKE_INSTALL_PREFIX}")
string(REGEX REPLACE "/$" "" LIMITCL_PC_UP "${LIMITCL_PC_UP}")
configure_file(cmake/limitcl.pc.in limitcl.pc @ONLY)
install(FILES "${PROJECT_BINARY_DIR}/limitcl.pc" DESTINATION "${CMAKE_INSTALL_LIBDIR}/pkgconfig")
