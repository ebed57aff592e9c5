#include "tests/octree/builder/patched_tree.h"

#include <cstdlib>

namespace planetree::octree {

PatchedTree::PatchedTree(const Soup& soup, std::uint64_t patch_triangles, std::uint32_t page_bytes,
                         storage::SpillFile& file)
    : mesh(store(soup)), runs(runs_of(mesh)), above(*cut_patches(*runs, patch_triangles)) {
  shape.float64 = mesh.float64();
  for (const Patch& patch : above.patches) {
    Triangles triangles = *runs->read(patch.from, patch.to);
    auto built = build_patch(triangles, mesh.frame.centre(), shape, page_bytes, file);
    if (!built) std::abort();
    patches.push_back(*std::move(built));
  }
  tree = std::make_unique<BuiltTree>(mesh.frame, above, patches, shape, page_bytes, file);
}

}  // namespace planetree::octree
