# What the library is built from; all of it from the system, nothing fetched.
# Tools, tests and benchmarks find what they need beyond this in their folders.

find_package(PkgConfig REQUIRED)
pkg_check_modules(liblz4 REQUIRED IMPORTED_TARGET liblz4)
pkg_check_modules(liburing REQUIRED IMPORTED_TARGET liburing>=2.2)
pkg_check_modules(libxxhash REQUIRED IMPORTED_TARGET libxxhash)
find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(hwy REQUIRED CONFIG)
find_package(TBB REQUIRED)
find_package(Boost REQUIRED)  # headers only: Multiprecision, for exact predicates
