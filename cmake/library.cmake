# planetree_add_library(NAME [STATIC|SHARED])
#
# The installed library: the layers in one archive, or in one shared object. Without a kind,
# BUILD_SHARED_LIBS chooses. All kinds consist of the same objects, which are position-independent.

# tests/layering fails when a header of include/planetree is not named here.
set(planetree_headers
  attributes.h
  build.h
  c.h
  c_types.h
  contact.h
  eigen.h
  error.h
  eviction_policy.h
  export.h
  layers.h
  metadata.h
  model.h
  planetree.h
  point_shell.h
  pose.h
  probe.h
  scene.h
  scene_shell.h
  shard.h
  stats.h
  trace.h
  types.h)
list(TRANSFORM planetree_headers PREPEND ${PROJECT_SOURCE_DIR}/include/planetree/)

set(planetree_library_layers
  error storage_system storage_file storage_http storage_spill cache_policy cache
  geometry page field attributes traversal nearest winding mask
  builder_job builder_mesh_stream builder_mesh_gltf builder_mesh_obj builder_mesh_sequence builder_mesh builder_sort builder_surface builder_tree
  builder_mask builder_field builder_attributes builder shard
  query_file query_answer query_serve query query_shell query_scene c)

function(planetree_add_library name)
  add_library(${name} ${ARGN})
  add_library(planetree::${name} ALIAS ${name})
  foreach(layer IN LISTS planetree_library_layers)
    get_target_property(kind planetree_${layer} TYPE)
    if(kind STREQUAL STATIC_LIBRARY)
      target_sources(${name} PRIVATE $<TARGET_OBJECTS:planetree_${layer}>)
    endif()
  endforeach()
  target_sources(${name} PUBLIC FILE_SET HEADERS
    BASE_DIRS ${PROJECT_SOURCE_DIR}/include FILES ${planetree_headers})
  target_link_libraries(${name} PRIVATE
    PkgConfig::liblz4 PkgConfig::liburing PkgConfig::libxxhash PkgConfig::libzstd PkgConfig::zlib
    $<$<BOOL:${PLANETREE_HTTP}>:PkgConfig::libcurl> hwy::hwy_contrib hwy::hwy TBB::tbb
    Threads::Threads)
  target_compile_features(${name} PUBLIC cxx_std_20)
  # Before 1.0 a minor version may change the interface.
  set_target_properties(${name} PROPERTIES
    LINKER_LANGUAGE CXX
    OUTPUT_NAME planetree
    EXPORT_NAME planetree
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  get_target_property(kind ${name} TYPE)
  if(kind STREQUAL SHARED_LIBRARY)
    set(script ${PROJECT_SOURCE_DIR}/cmake/planetree.map)
    target_link_options(${name} PRIVATE LINKER:--version-script=${script})
    set_target_properties(${name} PROPERTIES LINK_DEPENDS ${script})
  endif()
endfunction()
