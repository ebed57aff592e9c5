# CMAKE_UNITY_BUILD compiles several sources of a layer at once, as the build of the wheel does, to
# take less time. These layers have kernels, whose sources Highway includes again for each
# instruction set, or names that two sources have in common.
set(planetree_separate_layers
  planetree_geometry planetree_page planetree_traversal planetree_nearest planetree_winding
  planetree_mask planetree_builder_surface planetree_builder_mask planetree_query_answer)

# planetree_add_layer(NAME [EXCEPT files...] [DEPENDS targets...] [HEADERS headers...]
#                     [HEADERS_OF target])
#
# A static library, for use inside this project only, of the sources in the
# current folder. A folder without sources becomes an interface library.
#
# DEPENDS      the folders and the libraries that it may include; tests/layering holds the
#              sources to the same rows.
# HEADERS      large headers of other libraries, compiled once for all its sources.
# HEADERS_OF   a layer whose compiled headers it uses too.
function(planetree_add_layer name)
  cmake_parse_arguments(PARSE_ARGV 1 layer "" "HEADERS_OF" "EXCEPT;DEPENDS;HEADERS")
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
  if(name IN_LIST planetree_separate_layers)
    set_target_properties(${name} PROPERTIES UNITY_BUILD OFF)
  endif()
  if(layer_HEADERS)
    target_precompile_headers(${name} PRIVATE ${layer_HEADERS})
  elseif(layer_HEADERS_OF AND sources)
    target_precompile_headers(${name} REUSE_FROM ${layer_HEADERS_OF})
  endif()
  if(PLANETREE_BUILD_FUZZERS AND sources)
    target_compile_options(${name} PRIVATE -fsanitize=fuzzer-no-link)  # so that fuzzers see coverage
  endif()
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY ${PROJECT_SOURCE_DIR}
    OUTPUT_VARIABLE folder)
  list(JOIN layer_DEPENDS " " depends)
  set_property(GLOBAL APPEND PROPERTY planetree_layers "${name}|${folder}|${depends}")
endfunction()

# Writes all layers so far to a file, lowest first: a line NAME|FOLDER|DEPENDS for each, with blanks
# between the targets of DEPENDS. docs/draw-layers makes the drawing in docs/architecture.md of it.
function(planetree_write_layers path)
  get_property(layers GLOBAL PROPERTY planetree_layers)
  list(JOIN layers "\n" lines)
  file(CONFIGURE OUTPUT ${path} CONTENT "${lines}\n" @ONLY)
endfunction()

# planetree_kernels(FILES...)
#
# Sources of vector kernels. Clang takes minutes to instrument them for undefined behaviour, where
# vectors of floats have none. Their addresses are checked by calls: inline checks take five times
# as long to compile.
function(planetree_kernels)
  if(CMAKE_CXX_COMPILER_ID MATCHES Clang)
    set_source_files_properties(${ARGN} PROPERTIES COMPILE_OPTIONS
      "-fno-sanitize=undefined;-mllvm;-asan-instrumentation-with-call-threshold=0")
  endif()
endfunction()
