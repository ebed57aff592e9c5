# planetree_add_tests(LABEL [GEOMETRY] [TOGETHER] [PUBLIC] [EXCEPT beginnings...] [SLOW suites...]
#   [DEPENDS targets...])
#
# One program of the sources in the current folder and below it; each test in it is a test
# of ctest with this label.
# GEOMETRY: the tests compute much, with the headers that this takes. TOGETHER:
# compile several files at once; their names without a namespace must differ. PUBLIC: the tests
# see no header but those of the library they link, and of their own folder. SLOW: suites, as
# patterns of gtest, whose tests are not labelled LABEL_fast: `ctest -L fast` runs the others, in
# less than a minute.
find_package(GTest REQUIRED)
include(GoogleTest)

# Most of the time of a full run goes into compiling: so the headers that tests
# share are compiled once, and what is tested is optimised, tests are not. But
# with a sanitizer those that compute much are, for they would take minutes.
function(planetree_share_headers name)
  cmake_parse_arguments(PARSE_ARGV 1 shared "" "" "OPTIONS;HEADERS")
  add_executable(${name} ${PROJECT_SOURCE_DIR}/tests/headers.cpp)
  target_compile_definitions(${name} PRIVATE PLANETREE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  target_compile_options(${name} PRIVATE ${shared_OPTIONS})
  target_link_libraries(${name}
    PRIVATE GTest::gtest_main Eigen3::Eigen nlohmann_json::nlohmann_json)
  target_precompile_headers(${name} PRIVATE <gtest/gtest.h> <filesystem> <string> <vector>
    ${shared_HEADERS})
endfunction()
planetree_share_headers(test_headers
  OPTIONS $<$<CONFIG:Release,RelWithDebInfo>:-O0> HEADERS <nlohmann/json.hpp>)
planetree_share_headers(geometry_test_headers
  OPTIONS $<$<CONFIG:Release>:-O0>
  HEADERS <Eigen/Core> <boost/multiprecision/cpp_bin_float.hpp> <boost/multiprecision/cpp_int.hpp>)

function(planetree_add_tests label)
  cmake_parse_arguments(PARSE_ARGV 1 test "GEOMETRY;TOGETHER;PUBLIC" "" "EXCEPT;SLOW;DEPENDS")
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  foreach(pattern IN LISTS test_EXCEPT)
    list(FILTER sources EXCLUDE REGEX "^${pattern}")
  endforeach()
  set(headers test_headers)
  if(test_GEOMETRY)
    set(headers geometry_test_headers)
  endif()

  set(program ${label}_tests)
  add_executable(${program} ${sources})
  target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR})
  if(NOT test_PUBLIC)
    target_include_directories(${program} PRIVATE ${PROJECT_SOURCE_DIR}/include)
  endif()
  target_link_libraries(${program} PRIVATE ${test_DEPENDS} GTest::gtest_main)
  target_compile_definitions(${program}
    PRIVATE PLANETREE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
  get_target_property(options ${headers} COMPILE_OPTIONS)
  target_compile_options(${program} PRIVATE ${options})
  target_precompile_headers(${program} REUSE_FROM ${headers})
  set_target_properties(${program}
    PROPERTIES UNITY_BUILD ${test_TOGETHER} UNITY_BUILD_BATCH_SIZE 6)
  list(TRANSFORM test_SLOW APPEND ".*")
  list(JOIN test_SLOW ":" slow)
  if(slow STREQUAL "*.*")
    planetree_discover_tests(${program} "*" ${label})
  else()
    planetree_discover_tests(${program} "-${slow}" ${label}_fast)
    if(slow)
      planetree_discover_tests(${program} "${slow}" ${label})
    endif()
  endif()
endfunction()

# Tests of a program whose names fit a filter of gtest, with this label.
function(planetree_discover_tests program filter label)
  set(properties LABELS ${label} TIMEOUT 240)
  if(PLANETREE_DATA)
    list(APPEND properties ENVIRONMENT PLANETREE_DATA=${PLANETREE_DATA})
  endif()
  # A program lists its tests when ctest starts: while others still compile, a
  # busy machine could make it miss its time.
  gtest_discover_tests(${program} TEST_FILTER "${filter}" DISCOVERY_MODE PRE_TEST
    DISCOVERY_TIMEOUT 60 PROPERTIES ${properties})
endfunction()
