# planetree_add_layer(NAME [EXCEPT files...] [DEPENDS targets...])
#
# A static library, for use inside this project only, of the sources in the
# current folder. A folder without a source yet becomes an interface library.
function(planetree_add_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 layer "" "" "EXCEPT;DEPENDS")
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
endfunction()
