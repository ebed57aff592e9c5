#include "tools/check/page_rules.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

namespace planetree::tools {
namespace {

bool are_normals_in_range(const octree::RawStreams& streams) {
  for (std::size_t i = 0; i < streams.child_normals.size(); ++i)
    if (streams.child_normals[i] == std::numeric_limits<std::int16_t>::min()) return false;
  return true;
}

// Rounding may turn a decoded box inside out.
bool are_boxes_upright(const FrameView& frame) {
  for (std::uint32_t i = 0; i < frame.node_count(); ++i) {
    const octree::Node& node = frame.node(i);
    for (unsigned child = 0; child < node.child_count; ++child) {
      const octree::FloatBox box = child_box(node, child);
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (!(box.lower[axis] <= box.upper[axis])) return false;
    }
  }
  return true;
}

// Whether no position is there twice, and no coordinate is -0.
template <class Real>
bool are_positions_distinct(const octree::ByteSplit<Real>& vertices) {
  const std::size_t count = vertices.size() / 3;
  std::vector<std::array<Real, 3>> positions(count);
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Real value = vertices[axis * count + i];
      if (value == 0 && std::signbit(value)) return false;
      positions[i][axis] = value;
    }
  std::sort(positions.begin(), positions.end());
  return std::adjacent_find(positions.begin(), positions.end()) == positions.end();
}

// Whether the triangles use all vertices of a block, and the new ones in their order.
bool are_vertices_used_in_order(const octree::BlockView& block, unsigned new_count) {
  const unsigned count = block.header().vertex_count();
  unsigned next = count - new_count;
  std::uint64_t used = 0;
  for (unsigned i = 0; i < block.triangle_count(); ++i)
    for (const unsigned corner : block.header().corners(i)) {
      if (corner > next) return false;
      if (corner == next) ++next;
      used |= std::uint64_t{1} << corner;
    }
  return next == count && used == (std::uint64_t{1} << count) - 1;
}

}  // namespace

const char* fault_of_rules(const octree::RawStreams& streams, const FrameView& frame,
                           std::uint32_t ordinal) {
  if (streams.head.ordinal != ordinal)
    return "the page's ordinal is not its rank among the pages of its octcode; build the file "
           "again";
  if (!are_normals_in_range(streams)) return "a normal is out of range; build the file again";
  if (!are_boxes_upright(frame)) return "a child's box is inside out; build the file again";
  if (!are_positions_distinct(streams.vertices32) || !are_positions_distinct(streams.vertices64))
    return "a vertex is there twice or has a coordinate of -0; build the file again";
  bool are_in_order = true;
  frame.for_each_block([&](std::uint32_t i, const octree::BlockView& block) {
    are_in_order = are_in_order && are_vertices_used_in_order(block, streams.new_counts[i]);
  });
  return are_in_order ? nullptr
                      : "vertices are not in the order of their first use; build the file again";
}

}  // namespace planetree::tools
