# The installed library: the layers in one archive, or in one shared object with
# BUILD_SHARED_LIBS. Trees are built by the command, so octree/builder stays outside.

# tests/layering fails when a header of include/planetree is not named here.
set(planetree_headers
  error.h
  model.h
  planetree.h
  probe.h
  stats.h
  trace.h
  types.h)

add_library(planetree)
add_library(planetree::planetree ALIAS planetree)
foreach(layer error storage_system storage_file cache geometry page traversal nearest winding mask
        query_file query_answer query_serve query)
  get_target_property(kind planetree_${layer} TYPE)
  if(kind STREQUAL STATIC_LIBRARY)
    target_sources(planetree PRIVATE $<TARGET_OBJECTS:planetree_${layer}>)
  endif()
endforeach()

list(TRANSFORM planetree_headers PREPEND ${PROJECT_SOURCE_DIR}/include/planetree/)
target_sources(planetree PUBLIC FILE_SET HEADERS
  BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${planetree_headers})
target_link_libraries(planetree PRIVATE
  PkgConfig::liblz4 PkgConfig::liburing PkgConfig::libxxhash
  hwy::hwy_contrib hwy::hwy TBB::tbb Threads::Threads)
target_compile_features(planetree PUBLIC cxx_std_20)
# Before 1.0 a minor version may change the interface.
set_target_properties(planetree PROPERTIES
  LINKER_LANGUAGE CXX
  VERSION ${PROJECT_VERSION}
  SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
