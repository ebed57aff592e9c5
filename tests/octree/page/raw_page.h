#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/tree/stream_writer.h"
#include "octree/page/page_streams.h"
#include "tests/octree/page/stream_list.h"

namespace planetree::octree {

/// The streams of a page with float32 vertices and 4-byte ids, separated so that a test can corrupt
/// one value and encode the page again. The counts in the head are not updated.
struct RawPage {
  PageHead head{};
  std::vector<float> root_boxes;
  std::vector<std::uint8_t> child_counts, heights;
  std::vector<std::uint16_t> child_kinds;
  std::vector<std::uint8_t> child_boxes;
  std::vector<std::int16_t> child_normals, child_slabs;
  std::vector<std::uint16_t> child_radii;
  std::vector<std::int16_t> child_dipoles;
  std::vector<std::int8_t> child_quadrupoles;
  std::vector<std::uint16_t> child_areas, child_second_moments;
  std::vector<std::uint32_t> linked_pages;
  std::vector<std::uint16_t> linked_nodes;
  std::vector<std::uint8_t> triangle_counts, vertex_counts, new_counts;
  std::vector<std::uint16_t> vertex_refs;
  std::vector<std::byte> corners;
  std::vector<float> vertices;
  std::vector<std::uint32_t> first_ids, id_steps;

  /// Returns the streams of `raw`, whose counts must match its length.
  static RawPage of(std::span<const std::byte> raw, const BlockShape& shape = {}) {
    RawStreams s;
    if (s.read(raw, shape) != nullptr) return {};
    return {s.head,
            list(s.root_boxes),
            list(s.child_counts),
            list(s.heights),
            list(s.child_kinds),
            list(s.child_boxes),
            list(s.child_normals),
            list(s.child_slabs),
            list(s.child_radii),
            list(s.child_dipoles),
            list(s.child_quadrupoles),
            list(s.child_areas),
            list(s.child_second_moments),
            list(s.linked_pages),
            list(s.linked_nodes),
            list(s.triangle_counts),
            list(s.vertex_counts),
            list(s.new_counts),
            list(s.vertex_refs),
            {s.corners.begin(), s.corners.end()},
            list(s.vertices32),
            list(s.first_ids32),
            list(s.id_steps32)};
  }

  /// Repeats the only block of the page. The second block refers to the vertices of the first.
  void repeat_block() {
    const unsigned vertex_count = vertex_counts[0];
    ++head.block_count;
    head.triangle_count = static_cast<std::uint16_t>(2 * head.triangle_count);
    head.vertex_ref_count = static_cast<std::uint16_t>(vertex_count);
    triangle_counts.push_back(triangle_counts[0]);
    vertex_counts.push_back(vertex_counts[0]);
    new_counts.push_back(0);
    vertex_refs.assign(vertex_count, 1);
    vertex_refs[0] = 0;
    const auto repeat = [](auto& stream) {
      const auto copy = stream;
      stream.insert(stream.end(), copy.begin(), copy.end());
    };
    repeat(corners);
    repeat(first_ids);
    repeat(id_steps);
  }

  std::vector<std::byte> bytes() const {
    StreamWriter writer;
    writer.plain(&head, sizeof head);
    writer.byte_split(root_boxes);
    writer.byte_split(child_counts);
    writer.byte_split(heights);
    writer.byte_split(child_kinds);
    writer.byte_split(child_boxes);
    writer.byte_split(child_normals);
    writer.byte_split(child_slabs);
    writer.byte_split(child_radii);
    writer.byte_split(child_dipoles);
    writer.byte_split(child_quadrupoles);
    writer.byte_split(child_areas);
    writer.byte_split(child_second_moments);
    writer.byte_split(linked_pages);
    writer.byte_split(linked_nodes);
    writer.byte_split(triangle_counts);
    writer.byte_split(vertex_counts);
    writer.byte_split(new_counts);
    writer.byte_split(vertex_refs);
    writer.plain(corners.data(), corners.size());
    writer.byte_split(vertices);
    writer.byte_split(first_ids);
    writer.byte_split(id_steps);
    return writer.take();
  }
};

}  // namespace planetree::octree
