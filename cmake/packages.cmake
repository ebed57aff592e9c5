# Debian packages: `./dev package` writes them to build/package.
#
#   libplanetree0.1    the shared library
#   libplanetree-dev   headers, CMake package, pkg-config file
#   planetree          the command, man pages, completion, media type
#   python3-planetree  the Python package, for Debian's interpreter
set(planetree_soversion ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
set(planetree_runtime_package libplanetree${planetree_soversion})
set(planetree_development_package libplanetree-dev)
set(planetree_tools_package planetree)
set(planetree_python_package python3-planetree)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME planetree)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(PLANETREE_PACKAGE_CONTACT "The planetree authors <planetree@users.noreply.github.com>"
  CACHE STRING "Maintainer that Debian packages name")
set(CPACK_PACKAGE_CONTACT "${PLANETREE_PACKAGE_CONTACT}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_DESCRIPTION}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL runtime development tools python)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/packages/triggers)
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/packages/python/postinst
  ${PROJECT_SOURCE_DIR}/cmake/packages/python/prerm)
set(planetree_same_version "(= ${PROJECT_VERSION}-1)")

# planetree_describe_package(COMPONENT SECTION TEXT [DEPENDS packages])
#
# Names a package, describes it, and installs its copyright and changelog.
function(planetree_describe_package component section text)
  cmake_parse_arguments(PARSE_ARGV 3 package "" "DEPENDS" "")
  string(TOUPPER ${component} upper)
  set(name ${planetree_${component}_package})
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${name} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION ${section} PARENT_SCOPE)
  set(CPACK_DEBIAN_${upper}_PACKAGE_DEPENDS "${package_DEPENDS}" PARENT_SCOPE)
  set(CPACK_COMPONENT_${upper}_DESCRIPTION "${text}" PARENT_SCOPE)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/packages/copyright
    DESTINATION share/doc/${name} COMPONENT ${component})
  install(FILES ${PROJECT_BINARY_DIR}/changelog.gz
    DESTINATION share/doc/${name} COMPONENT ${component} RENAME changelog.Debian.gz)
endfunction()

planetree_describe_package(runtime libs
  "The library planetree computes, for any point, the distance to the surface of\na mesh, the nearest point, the normal there and whether the point is inside.")
planetree_describe_package(development libdevel
  "Headers in C++20 and C11, a CMake package and a pkg-config file."
  DEPENDS "${planetree_runtime_package} ${planetree_same_version}")
planetree_describe_package(tools science
  "The command planetree builds .ptree files from scans, queries, inspects,\ncompares and checks them.")
planetree_describe_package(python python
  "The package planetree answers queries of NumPy arrays."
  DEPENDS "${planetree_runtime_package} ${planetree_same_version}, python3, python3-numpy")

# The form of a Debian changelog, for the version alone.
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/changelog @ONLY
  CONTENT "planetree (@PROJECT_VERSION@-1) unstable; urgency=medium\n\n  * See CHANGELOG.md of the sources.\n\n -- @PLANETREE_PACKAGE_CONTACT@  Fri, 27 Nov 2026 00:00:00 +0000\n")
execute_process(COMMAND gzip -9nc ${PROJECT_BINARY_DIR}/changelog
  OUTPUT_FILE ${PROJECT_BINARY_DIR}/changelog.gz COMMAND_ERROR_IS_FATAL ANY)

# Debian wants its man pages compressed.
install(CODE "file(GLOB pages \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/share/man/man1/*.1\")
execute_process(COMMAND gzip -9nf \${pages} COMMAND_ERROR_IS_FATAL ANY)" COMPONENT tools)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/packages/planetree.xml
  DESTINATION share/mime/packages COMPONENT tools)
install(FILES ${PROJECT_SOURCE_DIR}/cmake/packages/magic
  DESTINATION share/planetree COMPONENT tools)
include(CPack)
