#include "tools/report/stream_rows.h"

#include <array>

namespace planetree::tools {
namespace {

template <class T>
StreamRow row(std::string_view name, StreamGroup group, const octree::ByteSplit<T>& stream) {
  return {name, group, stream.size(), octree::ByteSplit<T>::bytes_for(stream.size())};
}

}  // namespace

std::string_view group_name(StreamGroup group) {
  static constexpr std::array<std::string_view, kStreamGroupCount> kNames = {
      "heads", "nodes", "blocks",     "corners", "vertices",
      "ids",   "mask",  "mask_lists", "field",   "attributes"};
  return kNames[static_cast<std::size_t>(group)];
}

std::vector<StreamRow> stream_rows(const octree::RawStreams& streams,
                                   const octree::BlockShape& shape) {
  using enum StreamGroup;
  const octree::RawStreams& s = streams;
  std::vector<StreamRow> rows = {
      {"page_head", kHead, 1, sizeof(octree::PageHead)}, row("root_boxes", kNodes, s.root_boxes),
      row("child_counts", kNodes, s.child_counts),       row("heights", kNodes, s.heights),
      row("child_kinds", kNodes, s.child_kinds),         row("child_boxes", kNodes, s.child_boxes),
      row("child_normals", kNodes, s.child_normals),     row("child_slabs", kNodes, s.child_slabs),
      row("child_radii", kNodes, s.child_radii)};
  if (shape.moments) {
    rows.push_back(row("child_dipoles", kNodes, s.child_dipoles));
    rows.push_back(row("child_quadrupoles", kNodes, s.child_quadrupoles));
    rows.push_back(row("child_areas", kNodes, s.child_areas));
    rows.push_back(row("child_second_moments", kNodes, s.child_second_moments));
  }
  const std::vector<StreamRow> others = {
      row("linked_pages", kNodes, s.linked_pages),
      row("linked_nodes", kNodes, s.linked_nodes),
      row("triangle_counts", kBlocks, s.triangle_counts),
      row("vertex_counts", kBlocks, s.vertex_counts),
      row("new_counts", kBlocks, s.new_counts),
      row("vertex_refs", kVertices, s.vertex_refs),
      {"corners", kCorners, s.corners.size(), s.corners.size()},
      shape.float64 ? row("vertices", kVertices, s.vertices64)
                    : row("vertices", kVertices, s.vertices32),
      shape.wide_ids ? row("first_ids", kIds, s.first_ids64)
                     : row("first_ids", kIds, s.first_ids32),
      shape.wide_ids ? row("id_steps", kIds, s.id_steps64) : row("id_steps", kIds, s.id_steps32)};
  rows.insert(rows.end(), others.begin(), others.end());
  return rows;
}

std::vector<StreamRow> stream_rows(const octree::FieldPageHead& head) {
  const std::uint64_t points = head.point_count, bytes = points * sizeof(std::uint16_t);
  return {{"field_page_head", StreamGroup::kHead, 1, sizeof head},
          {"x_steps", StreamGroup::kField, points, bytes},
          {"y_steps", StreamGroup::kField, points, bytes},
          {"z_steps", StreamGroup::kField, points, bytes}};
}

std::vector<StreamRow> stream_rows(const octree::AttributePageHead& head,
                                   octree::AttributeShape shape) {
  using Shape = octree::AttributeShape;
  constexpr StreamGroup kGroup = StreamGroup::kAttributes;
  const std::uint64_t count = head.triangle_count;
  std::vector<StreamRow> rows = {{"attribute_page_head", StreamGroup::kHead, 1, sizeof head},
                                 {"triangle_pages", kGroup, count, count * sizeof(std::uint32_t)},
                                 {"triangle_blocks", kGroup, count, count * sizeof(std::uint16_t)}};
  if (shape.has_colors()) rows.push_back({"colours", kGroup, count, count * Shape::kColorBytes});
  if (shape.has_uvs()) rows.push_back({"uvs", kGroup, 6 * count, count * Shape::kUvBytes});
  if (shape.has_values()) rows.push_back({"values", kGroup, count, count * Shape::kValueBytes});
  return rows;
}

std::vector<StreamRow> stream_rows(const octree::MaskStreams& streams,
                                   const octree::BlockShape& shape) {
  using enum StreamGroup;
  const octree::MaskStreams& s = streams;
  return {{"mask_page_head", kHead, 1, sizeof(octree::MaskPageHead)},
          row("record_kinds", kMask, s.kinds),
          row("grey_masks", kMask, s.grey),
          row("leaf_masks", kMask, s.leaf),
          row("black_masks", kMask, s.black),
          row("inverted_masks", kMask, s.inverted),
          row("mask_linked_pages", kMask, s.linked_pages),
          row("mask_linked_records", kMask, s.linked_records),
          row("corner_bits", kMask, s.plain_corners),
          row("mask_corners", kMask, s.corners),
          row("plane_counts", kMask, s.plane_counts),
          row("behind", kMask, s.behind),
          row("beyond", kMask, s.beyond),
          shape.float64 ? row("planes", kMask, s.planes64) : row("planes", kMask, s.planes32),
          row("least", kMaskLists, s.least),
          row("higher", kMaskLists, s.higher),
          row("block_counts", kMaskLists, s.block_counts),
          row("slab_directions", kMaskLists, s.slab_directions),
          row("slab_lowers", kMaskLists, s.slab_lowers),
          row("slab_uppers", kMaskLists, s.slab_uppers),
          row("block_octants", kMaskLists, s.block_octants),
          row("block_pages", kMaskLists, s.block_pages),
          row("block_numbers", kMaskLists, s.block_numbers)};
}

}  // namespace planetree::tools
