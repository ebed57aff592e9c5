#include "octree/builder/mesh/gltf/gltf_scene.h"

#include <algorithm>
#include <span>
#include <utility>

#include "octree/builder/mesh/gltf/gltf_error.h"
#include "octree/builder/mesh/stream/mesh_note.h"

namespace planetree::octree {

namespace {

/// Walks the trees of nodes. The nodes to visit are a stack in memory of its own, however deep the
/// trees are.
class GltfWalk {
 public:
  explicit GltfWalk(const GltfDocument& document)
      : document_(document),
        is_visited_(document.nodes.size()),
        is_placed_(document.meshes.size()) {}

  Result<GltfScene> run() {
    if (document_.nodes.empty()) {
      for (std::uint64_t mesh = 0; mesh < document_.meshes.size(); ++mesh) place(mesh, {});
      return std::move(scene_);
    }
    if (const auto good = push_roots(); !good) return good.error();
    while (!stack_.empty()) {
      const Visit visit = stack_.back();
      stack_.pop_back();
      if (const auto good = enter(visit); !good) return good.error();
    }
    note();
    return std::move(scene_);
  }

 private:
  struct Visit {
    std::uint64_t node = 0;
    GltfTransform parent;
  };

  [[nodiscard]] std::span<const std::uint64_t> links(const GltfSlice& slice) const {
    return std::span(document_.links).subspan(slice.first, slice.count);
  }

  Result<void> push_roots() {
    if (document_.scenes.empty()) return push_parentless();
    const std::uint64_t scene = document_.scene.value_or(0);
    if (scene >= document_.scenes.size())
      return gltf_error("scene " + std::to_string(scene) + " does not exist");
    push(links(document_.scenes[scene]), {});
    return {};
  }

  Result<void> push_parentless() {
    std::vector<bool> has_parent(document_.nodes.size());
    for (const std::uint64_t child : document_.links)
      if (child < has_parent.size()) has_parent[child] = true;
    std::vector<std::uint64_t> roots;
    for (std::uint64_t node = 0; node < has_parent.size(); ++node)
      if (!has_parent[node]) roots.push_back(node);
    push(roots, {});
    return {};
  }

  /// Pushes nodes so that the first is visited next.
  void push(std::span<const std::uint64_t> nodes, const GltfTransform& parent) {
    for (std::size_t i = nodes.size(); i > 0; --i) stack_.push_back({nodes[i - 1], parent});
  }

  Result<void> enter(const Visit& visit) {
    const std::string name = "node " + std::to_string(visit.node);
    if (visit.node >= document_.nodes.size()) return gltf_error(name + " does not exist");
    if (is_visited_[visit.node]) return gltf_error(name + " is in the tree of nodes twice");
    is_visited_[visit.node] = true;
    const GltfNode& node = document_.nodes[visit.node];
    const GltfTransform global = visit.parent * node.local;
    push(links(node.children), global);
    if (!node.mesh) return {};
    if (*node.mesh >= document_.meshes.size())
      return gltf_error(name + " has a mesh that does not exist");
    if (node.has_instances) ++instanced_;
    if (node.has_skin) ++skinned_;
    // The joints place a mesh with a skin, and the transform of its node is not applied.
    place(*node.mesh, node.has_skin ? GltfTransform() : global);
    return {};
  }

  void place(std::uint64_t mesh, const GltfTransform& transform) {
    scene_.placements.push_back({mesh, transform});
    is_placed_[mesh] = true;
  }

  void note() {
    const auto add = [this](std::uint64_t count, const std::string& what, const char* end,
                            const char* text) {
      if (count > 0) scene_.notes.push_back(counted(count, what, end) + text);
    };
    const std::uint64_t placed = std::ranges::count(is_placed_, true);
    add(is_placed_.size() - placed, "mesh", "es", " of no node of the scene not read");
    add(skinned_, "mesh", "es", " with a skin read as stored, in no pose of its joints");
    add(instanced_, "node", "s", " with instances (EXT_mesh_gpu_instancing) read once");
  }

  const GltfDocument& document_;
  std::vector<bool> is_visited_, is_placed_;
  std::vector<Visit> stack_;
  GltfScene scene_;
  std::uint64_t skinned_ = 0, instanced_ = 0;
};

}  // namespace

Result<GltfScene> place_meshes(const GltfDocument& document) { return GltfWalk(document).run(); }

}  // namespace planetree::octree
