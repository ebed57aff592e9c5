#include "octree/builder/mesh/gltf/gltf_extensions.h"

#include <string>
#include <string_view>

#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

namespace {

/// How extensions begin that say nothing of triangles.
constexpr std::string_view kHarmless[] = {"KHR_materials_",
                                          "KHR_texture_",
                                          "KHR_lights_",
                                          "KHR_animation_pointer",
                                          "KHR_xmp",
                                          "EXT_texture_",
                                          "EXT_lights_",
                                          "EXT_mesh_features",
                                          "EXT_mesh_manifold",
                                          "MSFT_texture_",
                                          "EXT_structural_metadata",
                                          "EXT_feature_metadata",
                                          "KHR_techniques_webgl",
                                          "CESIUM_primitive_outline",
                                          "KHR_audio",
                                          "KHR_physics_"};

/// Extensions that are read, or whose compressed form is refused where a primitive needs it.
constexpr std::string_view kRead[] = {"KHR_mesh_quantization"};

bool is_harmless(std::string_view extension) {
  for (const std::string_view begin : kHarmless)
    if (extension.starts_with(begin)) return true;
  for (const std::string_view read : kRead)
    if (extension == read) return true;
  return false;
}

}  // namespace

bool has_meshopt(const GltfObject& object) {
  return object.has_extension("EXT_meshopt_compression") ||
         object.has_extension("KHR_meshopt_compression");
}

void check_extensions(const GltfObject& root) {
  for (const std::string& extension : root.texts("extensionsRequired")) {
    if (is_harmless(extension)) continue;
    if (extension == kDraco)
      throw GltfFault(gltf_error("its triangles are compressed by Draco (" + extension + ')',
                                 "export it without compression"));
    if (extension.find("meshopt") != std::string::npos)
      throw GltfFault(gltf_error("it is compressed by meshoptimizer (" + extension + ')',
                                 "export it without compression"));
    throw GltfFault(
        gltf_error("it requires the extension '" + printable(extension) + "', which is not read",
                   "export it without that extension"));
  }
}

}  // namespace planetree::octree
