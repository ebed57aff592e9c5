#include "octree/builder/tree/chunk_build.h"

#include <algorithm>

#include "octree/builder/sort/morton_order.h"
#include "octree/builder/tree/binary_tree.h"
#include "octree/builder/tree/block_slots.h"
#include "octree/builder/tree/chunk_vertices.h"
#include "octree/builder/tree/disc_fit.h"
#include "octree/builder/tree/page_encoder.h"
#include "octree/builder/tree/wide_tree.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

void describe(const Triangles& triangles, const WideTree& tree, BuiltChunk& chunk) {
  chunk.node_count = tree.nodes.size();
  chunk.block_count = tree.blocks.size();
  chunk.min_code = morton_part(triangles.code(0));
  chunk.greatest_code = morton_part(triangles.code(triangles.size() - 1));
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    chunk.area += area_vector(triangles.corners(i));
  if (tree.nodes.empty()) {
    chunk.boxes_below = {chunk.box};
    return;
  }
  chunk.height = tree.nodes[0].height;
  chunk.boxes_below = boxes_below(tree, tree.nodes[0]);
}

}  // namespace

Result<BuiltChunk> build_chunk(const Triangles& triangles, bool is_whole, const Point& centre,
                               const BlockShape& shape, std::uint32_t page_bytes,
                               storage::SpillFile& file) {
  BuiltChunk chunk;
  std::vector<MortonKey> keys = keys_of(triangles);
  WideTree tree;
  {
    const std::vector<BinaryNode> binary = build_binary_tree(triangles, centre, keys);
    chunk.box = binary[0].box;
    tree = collapse(binary);
  }
  ChunkVertices vertices(triangles);
  vertices.list_blocks(tree.blocks, keys);
  const std::vector<std::uint8_t> of_blocks =
      block_slots(triangles, vertices, keys, tree.blocks, shape);
  const RecordSlots slots{shape.node_slots(), of_blocks};
  part_blocks(tree, slots, page_bytes);
  if (tree.nodes.empty() && !is_whole) add_root(tree, chunk.box);
  fit_discs(triangles, vertices, centre, keys, tree);
  if (shape.moments) {
    TreeMoments moments = sum_moments(triangles, centre, keys, tree, chunk.box);
    tree.moments = std::move(moments.nodes);
    chunk.sums = moments.root;
  }
  describe(triangles, tree, chunk);
  const auto plan = plan_pages(tree, keys, slots, page_bytes);
  if (!plan) return plan.error();
  const PageEncoder encoder(triangles, vertices, keys, tree, *plan, shape);
  for (const PlannedPage& page : plan->pages) {
    const auto spilled = spill_page(page.octcode, encoder.encode(page.number), file);
    if (!spilled) return spilled.error();
    chunk.pages.push_back(*spilled);
  }
  return chunk;
}

}  // namespace planetree::octree
