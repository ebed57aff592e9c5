# Library, headers, CMake package and planetree.pc; tools/ installs the command.

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/planetree)
install(TARGETS planetree EXPORT planetreeTargets FILE_SET HEADERS)
install(EXPORT planetreeTargets NAMESPACE planetree:: DESTINATION ${package_dir})

configure_package_config_file(
  ${PROJECT_SOURCE_DIR}/cmake/planetreeConfig.cmake.in planetreeConfig.cmake
  INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(planetreeConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${CMAKE_CURRENT_BINARY_DIR}/planetreeConfig.cmake
  ${CMAKE_CURRENT_BINARY_DIR}/planetreeConfigVersion.cmake
  DESTINATION ${package_dir})

# An archive leaves its own needs to the program that links it; a shared object
# brings them along.
set(pkgconfig_requires "liblz4 liburing >= 2.2 libxxhash libhwy-contrib libhwy tbb")
set(pkgconfig_pthread " -pthread")
if(BUILD_SHARED_LIBS)
  set(pkgconfig_requires "")
  set(pkgconfig_pthread "")
endif()
file(RELATIVE_PATH pkgconfig_to_prefix
  ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
configure_file(${PROJECT_SOURCE_DIR}/cmake/planetree.pc.in planetree.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/planetree.pc
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
