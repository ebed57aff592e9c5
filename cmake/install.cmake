# planetree_install_library(TARGET [COMPONENT component])
#
# Installs a library with its headers, its CMake package and planetree.pc. A shared object belongs
# to the component `runtime`, everything else to `development`; tools/ installs the command as
# `tools`. With COMPONENT all of it belongs to that component, which only
# `cmake --install --component` installs.

include(CMakePackageConfigHelpers)
include(GNUInstallDirs)

function(planetree_install_library target)
  cmake_parse_arguments(PARSE_ARGV 1 install "" "COMPONENT" "")
  set(runtime COMPONENT runtime)
  set(development COMPONENT development)
  set(namelink NAMELINK_COMPONENT development)
  if(install_COMPONENT)
    set(runtime COMPONENT ${install_COMPONENT} EXCLUDE_FROM_ALL)
    set(development ${runtime})
    set(namelink "")
  endif()
  set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/planetree)
  set(generated ${CMAKE_CURRENT_BINARY_DIR}/${target}-package)
  get_target_property(kind ${target} TYPE)
  set(planetree_is_shared OFF)
  set(planetree_has_http ${PLANETREE_HTTP})
  if(kind STREQUAL SHARED_LIBRARY)
    set(planetree_is_shared ON)
  endif()

  install(TARGETS ${target} EXPORT ${target}Targets
    LIBRARY ${runtime} ${namelink}
    ARCHIVE ${development}
    FILE_SET HEADERS ${development})
  install(EXPORT ${target}Targets NAMESPACE planetree:: FILE planetreeTargets.cmake
    DESTINATION ${package_dir} ${development})

  configure_package_config_file(
    ${PROJECT_SOURCE_DIR}/cmake/planetreeConfig.cmake.in ${generated}/planetreeConfig.cmake
    INSTALL_DESTINATION ${package_dir})
  write_basic_package_version_file(${generated}/planetreeConfigVersion.cmake
    COMPATIBILITY SameMinorVersion)
  install(FILES ${generated}/planetreeConfig.cmake ${generated}/planetreeConfigVersion.cmake
    DESTINATION ${package_dir} ${development})

  # An archive leaves its own needs to the program that links it, such as the C++ library to one in
  # C; a shared object brings them along.
  set(pkgconfig_requires "liblz4 liburing >= 2.2 libxxhash libzstd zlib libhwy-contrib libhwy tbb")
  if(PLANETREE_HTTP)
    string(APPEND pkgconfig_requires " libcurl")
  endif()
  set(pkgconfig_libraries " -pthread -lstdc++ -lm")
  if(planetree_is_shared)
    set(pkgconfig_requires "")
    set(pkgconfig_libraries "")
  endif()
  file(RELATIVE_PATH pkgconfig_to_prefix
    ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/planetree.pc.in ${generated}/planetree.pc @ONLY)
  install(FILES ${generated}/planetree.pc
    DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig ${development})
endfunction()
