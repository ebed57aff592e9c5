# How every file here is compiled. Answers and files must not depend on the
# compiler or the processor, so contraction to fused multiply-add is off and no
# file is compiled for a particular processor (Highway chooses at run time).
#
# All of this holds in this folder and below. A project that adds this one by add_subdirectory()
# keeps its own options, and sees no warnings about code of ours.

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
  set(CMAKE_BUILD_TYPE Release)
endif()
string(REPLACE "-O3" "-O2" CMAKE_CXX_FLAGS_RELEASE "${CMAKE_CXX_FLAGS_RELEASE}")

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

add_compile_options(-ffp-contract=off)
if(NOT PROJECT_IS_TOP_LEVEL)
  return()
endif()

set(CMAKE_EXPORT_COMPILE_COMMANDS ON)

add_compile_options(-Wall -Wextra -Wpedantic -Wconversion -Wshadow)
# g++ leaves this out of -Wconversion; Eigen and std::array index with different signs.
add_compile_options($<$<CXX_COMPILER_ID:Clang>:-Wno-sign-conversion>)
set(CMAKE_COMPILE_WARNING_AS_ERROR ON)

find_program(CCACHE ccache)
mark_as_advanced(CCACHE)
if(CCACHE)
  # Precompiled headers are cached only if told so. With CCACHE_DEPEND the dependencies come from
  # the compiler, so that a file that is not in the cache is not preprocessed twice.
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
    CCACHE_DEPEND=1 CCACHE_SLOPPINESS=pch_defines,time_macros ${CCACHE})
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")
  endif()
endif()
