#include "octree/page/page_streams.h"

#include "octree/page/byte_split.h"

namespace planetree::octree {
namespace {

const char* check_head(const PageHead& head) {
  if (head.node_count == 0 && head.block_count == 0) return "the page holds no record";
  if (head.root_count > head.node_count || (head.root_count == 0 && head.node_count > 0))
    return "the count of subtree roots does not fit";
  if (head.child_count > kFanOut * head.node_count || head.page_link_count > head.child_count)
    return "the counts of children do not fit";
  if (head.triangle_count > kMaxBlockTriangles * head.block_count ||
      head.triangle_count < head.block_count)
    return "the count of triangles does not fit";
  for (const std::uint16_t word : head.reserved)
    if (word != 0) return "a reserved field is not zero";
  return nullptr;
}

void take_nodes(StreamReader& layout, RawStreams& s, const BlockShape& shape) {
  const PageHead& head = s.head;
  layout.take(s.root_boxes, 6 * std::size_t{head.root_count});
  layout.take(s.child_counts, head.node_count);
  layout.take(s.heights, head.node_count);
  layout.take(s.child_kinds, head.node_count);
  layout.take(s.child_boxes, 6 * std::size_t{head.child_count});
  layout.take(s.child_normals, 2 * std::size_t{head.child_count});
  layout.take(s.child_slabs, 2 * std::size_t{head.child_count});
  layout.take(s.child_radii, head.child_count);
  if (shape.moments) {
    layout.take(s.child_dipoles, 3 * std::size_t{head.child_count});
    layout.take(s.child_quadrupoles, 5 * std::size_t{head.child_count});
    layout.take(s.child_areas, head.child_count);
    layout.take(s.child_second_moments, head.child_count);
  }
  layout.take(s.linked_pages, head.page_link_count);
  layout.take(s.linked_nodes, head.page_link_count);
}

// The length of the corner stream follows from the counts just read.
const char* take_corners(StreamReader& layout, RawStreams& s, const BlockShape& shape) {
  std::size_t bytes = 0, triangles = 0;
  for (std::size_t i = 0; i < s.head.block_count; ++i) {
    if (s.is_height_field(i) && shape.moments) return "a cap is in a height field";
    const unsigned triangle_count = s.triangle_count(i);
    const unsigned vertex_count = s.vertex_counts[i];
    if (triangle_count == 0 || triangle_count > kMaxBlockTriangles || vertex_count == 0 ||
        vertex_count > kMaxBlockVertices || s.new_counts[i] > vertex_count)
      return "a block's counts are out of range";
    bytes += corner_bytes(triangle_count, vertex_count);
    triangles += triangle_count;
  }
  if (triangles != s.head.triangle_count) return "the blocks' triangles do not add up";
  s.corners = layout.take_bytes(bytes);
  return nullptr;
}

void take_blocks(StreamReader& layout, RawStreams& s, const BlockShape& shape) {
  const PageHead& head = s.head;
  const std::size_t coordinates = 3 * std::size_t{head.vertex_count};
  const std::size_t steps = std::size_t{head.triangle_count} - head.block_count;
  if (shape.float64)
    layout.take(s.vertices64, coordinates);
  else
    layout.take(s.vertices32, coordinates);
  if (shape.wide_ids) {
    layout.take(s.first_ids64, head.block_count);
    layout.take(s.id_steps64, steps);
  } else {
    layout.take(s.first_ids32, head.block_count);
    layout.take(s.id_steps32, steps);
  }
}

}  // namespace

const char* RawStreams::read(std::span<const std::byte> raw, const BlockShape& shape) noexcept {
  constexpr const char* kShort = "the page is shorter than its counts say";
  if (raw.size() < sizeof(PageHead)) return kShort;
  std::memcpy(&head, raw.data(), sizeof head);
  if (const char* fault = check_head(head)) return fault;
  StreamReader layout(raw.subspan(sizeof head));
  take_nodes(layout, *this, shape);
  layout.take(triangle_counts, head.block_count);
  layout.take(vertex_counts, head.block_count);
  layout.take(new_counts, head.block_count);
  layout.take(vertex_refs, head.vertex_ref_count);
  if (!layout.has_sufficed()) return kShort;
  if (const char* fault = take_corners(layout, *this, shape)) return fault;
  take_blocks(layout, *this, shape);
  if (!layout.has_sufficed()) return kShort;
  return layout.empty() ? nullptr : "the page is longer than its counts say";
}

}  // namespace planetree::octree
