# planetree_add_layer(NAME [EXCEPT files...] [DEPENDS targets...] [HEADERS headers...])
#
# A static library, for use inside this project only, of the sources in the
# current folder. A folder without a source yet becomes an interface library.
# HEADERS, large ones of other libraries, are compiled once for all sources.
function(planetree_add_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 layer "" "" "EXCEPT;DEPENDS;HEADERS")
  file(GLOB sources CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.cpp)
  list(REMOVE_ITEM sources ${layer_EXCEPT})
  set(kind STATIC)
  set(scope PUBLIC)
  if(NOT sources)
    set(kind INTERFACE)
    set(scope INTERFACE)
  endif()
  add_library(${name} ${kind} ${sources})
  target_include_directories(${name}
    ${scope} ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
  target_link_libraries(${name} ${scope} ${layer_DEPENDS})
  if(layer_HEADERS)
    target_precompile_headers(${name} PRIVATE ${layer_HEADERS})
  endif()
  if(PLANETREE_BUILD_FUZZERS AND sources)
    target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)  # fuzzers see their way
  endif()
endfunction()
