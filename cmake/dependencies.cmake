# What the library is built from; all of it from the system, nothing fetched.
# Tools, tests and benchmarks find what they need beyond this in their folders.

# A program in a folder above links them too, so they are visible there.
set(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL ON)
find_package(PkgConfig REQUIRED)
pkg_check_modules(liblz4 REQUIRED IMPORTED_TARGET GLOBAL liblz4)
pkg_check_modules(liburing REQUIRED IMPORTED_TARGET GLOBAL liburing>=2.2)
pkg_check_modules(libxxhash REQUIRED IMPORTED_TARGET GLOBAL libxxhash)
pkg_check_modules(libzstd REQUIRED IMPORTED_TARGET GLOBAL libzstd)
pkg_check_modules(zlib REQUIRED IMPORTED_TARGET GLOBAL zlib)
# URLs, for which the library does without libcurl where it is not installed.
option(PLANETREE_HTTP "Read files from HTTP servers, by libcurl" ON)
if(PLANETREE_HTTP)
  pkg_check_modules(libcurl IMPORTED_TARGET GLOBAL libcurl>=7.85)
  if(NOT libcurl_FOUND)
    message(STATUS "libcurl is not installed: this build reads no URLs")
    set(PLANETREE_HTTP OFF)
  endif()
endif()
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(hwy REQUIRED CONFIG)
find_package(TBB REQUIRED)
find_package(nlohmann_json REQUIRED CONFIG)  # headers only
find_package(Boost REQUIRED)  # headers only: Multiprecision, for exact predicates
unset(CMAKE_FIND_PACKAGE_TARGETS_GLOBAL)
