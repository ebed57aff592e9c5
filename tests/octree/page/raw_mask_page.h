#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/tree/stream_writer.h"
#include "octree/page/mask_streams.h"
#include "tests/octree/page/stream_list.h"

namespace planetree::octree {

/// The streams of a mask page, separated so that a test can corrupt one value and encode the page
/// again. The counts in the head are not updated.
struct RawMaskPage {
  MaskPageHead head{};
  std::vector<std::uint8_t> kinds, grey, leaf, black, inverted;
  std::vector<std::uint32_t> linked_pages;
  std::vector<std::uint16_t> linked_records;
  std::vector<std::uint8_t> plain_corners;
  std::vector<std::int8_t> corners;
  std::vector<std::uint8_t> plane_counts;
  std::vector<std::int8_t> behind, beyond;
  std::vector<double> planes;
  std::vector<std::int8_t> least;
  std::vector<std::uint8_t> higher, block_counts;
  std::vector<std::uint16_t> slab_directions;
  std::vector<std::uint8_t> slab_lowers, slab_uppers, block_octants;
  std::vector<std::uint32_t> block_pages;
  std::vector<std::uint16_t> block_numbers;
  bool float64 = false;

  /// Returns the streams of `raw`, whose counts must match its length.
  static RawMaskPage of(std::span<const std::byte> raw, bool float64) {
    MaskStreams s;
    if (s.read(raw, float64) != nullptr) return {};
    RawMaskPage page{s.head,
                     list(s.kinds),
                     list(s.grey),
                     list(s.leaf),
                     list(s.black),
                     list(s.inverted),
                     list(s.linked_pages),
                     list(s.linked_records),
                     list(s.plain_corners),
                     list(s.corners),
                     list(s.plane_counts),
                     list(s.behind),
                     list(s.beyond),
                     {},
                     list(s.least),
                     list(s.higher),
                     list(s.block_counts),
                     list(s.slab_directions),
                     list(s.slab_lowers),
                     list(s.slab_uppers),
                     list(s.block_octants),
                     list(s.block_pages),
                     list(s.block_numbers),
                     float64};
    for (std::size_t i = 0; i < std::size_t{9} * s.head.plane_count; ++i)
      page.planes.push_back(s.plane_coordinate(i));
    return page;
  }

  std::vector<std::byte> bytes() const {
    StreamWriter writer;
    writer.plain(&head, sizeof head);
    writer.byte_split(kinds);
    writer.byte_split(grey);
    writer.byte_split(leaf);
    writer.byte_split(black);
    writer.byte_split(inverted);
    writer.byte_split(linked_pages);
    writer.byte_split(linked_records);
    writer.byte_split(plain_corners);
    writer.byte_split(corners);
    writer.byte_split(plane_counts);
    writer.byte_split(behind);
    writer.byte_split(beyond);
    if (float64)
      writer.byte_split(planes);
    else
      writer.byte_split(std::vector<float>(planes.begin(), planes.end()));
    writer.byte_split(least);
    writer.byte_split(higher);
    writer.byte_split(block_counts);
    writer.byte_split(slab_directions);
    writer.byte_split(slab_lowers);
    writer.byte_split(slab_uppers);
    writer.byte_split(block_octants);
    writer.byte_split(block_pages);
    writer.byte_split(block_numbers);
    return writer.take();
  }
};

}  // namespace planetree::octree
