# planetree_add_tests(LABEL [OPTIMISED] [EXCEPT files...] [DEPENDS targets...] [HEADERS headers...])
#
# One program of the sources in the current folder; each test in it is a test
# of ctest with this label. Nothing happens in a folder without a *_test.cpp.
# HEADERS, and GoogleTest's, are compiled once for all of them.
find_package(GTest REQUIRED)
include(GoogleTest)

function(planetree_add_tests label)
  cmake_parse_arguments(PARSE_ARGV 1 test "OPTIMISED" "" "EXCEPT;DEPENDS;HEADERS")
  file(GLOB tests CONFIGURE_DEPENDS *_test.cpp)
  if(NOT tests)
    return()
  endif()
  file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  list(REMOVE_ITEM sources ${test_EXCEPT})

  set(program ${label}_tests)
  add_executable(${program} ${sources})
  target_include_directories(${program}
    PRIVATE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(${program} PRIVATE ${test_DEPENDS} GTest::gtest_main)
  target_compile_definitions(${program}
    PRIVATE PLANETREE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  # Most of the time of a full run goes into compiling: what is tested is
  # optimised, tests are not unless they say that they compute much, or run
  # with a sanitizer.
  if(NOT test_OPTIMISED)
    target_compile_options(${program} PRIVATE $<$<CONFIG:Release>:-O0>)
  endif()
  target_precompile_headers(${program}
    PRIVATE <gtest/gtest.h> <filesystem> <string> <vector> ${test_HEADERS})
  set(properties LABELS ${label} TIMEOUT 120)
  if(PLANETREE_DATA)
    list(APPEND properties ENVIRONMENT PLANETREE_DATA=${PLANETREE_DATA})
  endif()
  # A program lists its tests when ctest starts: while others still compile, a
  # busy machine could make it miss its time.
  gtest_discover_tests(${program} DISCOVERY_MODE PRE_TEST DISCOVERY_TIMEOUT 60
    PROPERTIES ${properties})
endfunction()
