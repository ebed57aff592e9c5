#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/tree/stream_writer.h"
#include "octree/page/page_streams.h"
#include "octree/page/raw_streams.h"
#include "tests/octree/page/stream_list.h"

namespace planetree::octree {

/// The raw bytes of a page with float32 vertices and 4-byte ids, taken apart
/// so that a test can spoil one thing and put the rest together again. The
/// head's counts stay as they are unless they are what is spoilt.
struct RawPage {
  PageHead head{};
  std::vector<float> root_boxes;
  std::vector<std::uint8_t> child_counts, heights;
  std::vector<std::uint16_t> child_kinds;
  std::vector<std::uint8_t> child_boxes;
  std::vector<std::int16_t> child_normals, child_slabs;
  std::vector<std::uint16_t> child_radii;
  std::vector<std::int16_t> child_vectors;
  std::vector<std::int8_t> child_firsts;
  std::vector<std::uint16_t> child_areas, child_seconds;
  std::vector<std::uint32_t> page_links;
  std::vector<std::uint8_t> triangle_counts, vertex_counts, new_counts;
  std::vector<std::uint16_t> vertex_refs;
  std::vector<std::byte> corners;
  std::vector<float> vertices;
  std::vector<std::uint32_t> first_ids, id_steps;

  /// `raw` must be a page that can be cut.
  static RawPage of(std::span<const std::byte> raw, const BlockShape& shape = {}) {
    RawStreams s;
    if (s.cut(raw, shape) != nullptr) return {};
    return {s.head,
            list(s.root_boxes),
            list(s.child_counts),
            list(s.heights),
            list(s.child_kinds),
            list(s.child_boxes),
            list(s.child_normals),
            list(s.child_slabs),
            list(s.child_radii),
            list(s.child_vectors),
            list(s.child_firsts),
            list(s.child_areas),
            list(s.child_seconds),
            list(s.page_links),
            list(s.triangle_counts),
            list(s.vertex_counts),
            list(s.new_counts),
            list(s.vertex_refs),
            {s.corners.begin(), s.corners.end()},
            list(s.vertices32),
            list(s.first_ids32),
            list(s.id_steps32)};
  }

  std::vector<std::byte> bytes() const {
    StreamWriter writer;
    writer.plain(&head, sizeof head);
    writer.shuffled(root_boxes);
    writer.shuffled(child_counts);
    writer.shuffled(heights);
    writer.shuffled(child_kinds);
    writer.shuffled(child_boxes);
    writer.shuffled(child_normals);
    writer.shuffled(child_slabs);
    writer.shuffled(child_radii);
    writer.shuffled(child_vectors);
    writer.shuffled(child_firsts);
    writer.shuffled(child_areas);
    writer.shuffled(child_seconds);
    writer.shuffled(page_links);
    writer.shuffled(triangle_counts);
    writer.shuffled(vertex_counts);
    writer.shuffled(new_counts);
    writer.shuffled(vertex_refs);
    writer.plain(corners.data(), corners.size());
    writer.shuffled(vertices);
    writer.shuffled(first_ids);
    writer.shuffled(id_steps);
    return writer.take();
  }
};

}  // namespace planetree::octree
