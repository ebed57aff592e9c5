#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <iterator>

#include "storage/file/header_check.h"
#include "storage/file/header_faults.h"

namespace planetree::storage {
namespace {

constexpr int kMaxHeight = 96;
constexpr int kMaxMaskLevel = 19;
constexpr std::int32_t kMaxScaleExponent = 1200;
// Lengths in the model frame that bounds can be made of.
constexpr double kMaxStrayEdge = 0x1p60;
constexpr std::uint64_t kMaxShortIndices = std::uint64_t{1} << 32;
constexpr double kMaxCapArea = 0x1p1000;
constexpr std::uint64_t kMaxWinding = std::uint64_t{1} << 62;
constexpr std::uint64_t kMaxBlockTriangles = 16;
// Limits of coordinates in the model frame, the second of those in the core.
constexpr double kMaxCoordinate = 0x1p112, kMaxCoreCoordinate = 0x1.fffffffffffffp54;

// Whether all bytes are 0; those of -0 are not.
bool is_zero(double value) noexcept { return std::bit_cast<std::uint64_t>(value) == 0; }

// A tree has nodes if and only if its triangles are more than a block holds.
bool are_counts_of_tree(std::uint64_t triangles, std::uint64_t nodes,
                        std::uint64_t blocks) noexcept {
  return (nodes > 0) == (triangles > kMaxBlockTriangles) && (blocks > 0) == (triangles > 0);
}

Result<void> check_counts(const ModelRecord& model) noexcept {
  if (model.triangle_count == 0) {
    return bad_model(offsetof(ModelRecord, triangle_count), "there is no triangle");
  }
  if (!are_counts_of_tree(model.triangle_count, model.node_count, model.block_count)) {
    return bad_model(offsetof(ModelRecord, node_count),
                     "the counts of nodes and blocks are not those of so many triangles");
  }
  if (model.skipped_count > kNoTriangle - model.usable_triangles()) {
    return bad_model(offsetof(ModelRecord, skipped_count), "the counts of triangles overflow");
  }
  const bool names_one = model.first_skipped != kNoTriangle;
  if (names_one != (model.skipped_count > 0) ||
      (names_one && model.first_skipped >= model.index_count())) {
    return bad_model(offsetof(ModelRecord, first_skipped),
                     "the index of the first skipped triangle is not one");
  }
  if (model.sample_triangle >= model.index_count()) {
    return bad_model(offsetof(ModelRecord, sample_triangle),
                     "the sample triangle's index is out of range");
  }
  return {};
}

bool are_within(const ModelRecord& model, std::span<const double> values, double limit) noexcept {
  return std::all_of(values.begin(), values.end(), [&](double value) {
    return std::ldexp(std::fabs(value), model.scale_exponent) <= limit;
  });
}

Result<void> check_unbalanced_edges(const ModelRecord& model) noexcept {
  constexpr UnbalancedEdge kNothing{};
  for (std::uint64_t i = 0; i < std::size(model.unbalanced_edge); ++i) {
    const UnbalancedEdge& edge = model.unbalanced_edge[i];
    const bool listed = std::memcmp(&edge, &kNothing, sizeof edge) != 0;
    if (listed != (i < model.unbalanced_edge_count)) {
      return bad_model(offsetof(ModelRecord, unbalanced_edge),
                       "the list of unbalanced edges is not as long as their count");
    }
    if (!all_finite(edge.from) || !all_finite(edge.to) || (listed && edge.along == edge.against)) {
      return bad_model(offsetof(ModelRecord, unbalanced_edge), "a listed edge is not unbalanced");
    }
    if (edge.triangle >= model.index_count()) {
      return bad_model(offsetof(ModelRecord, unbalanced_edge),
                       "the index of a triangle with an unbalanced edge is out of range");
    }
  }
  return {};
}

// The core is a part of the box, and all of it where there are no strays.
bool is_core(const ModelRecord& model) noexcept {
  if (!all_finite(model.core_lower) || !all_finite(model.core_upper)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(model.box_lower[axis] <= model.core_lower[axis] &&
          model.core_lower[axis] <= model.core_upper[axis] &&
          model.core_upper[axis] <= model.box_upper[axis])) {
      return false;
    }
  }
  return model.stray_count > 0 ||
         (std::equal(std::begin(model.box_lower), std::end(model.box_lower), model.core_lower) &&
          std::equal(std::begin(model.box_upper), std::end(model.box_upper), model.core_upper));
}

Result<void> check_core(const ModelRecord& model) noexcept {
  if (!is_core(model)) {
    return bad_model(offsetof(ModelRecord, core_lower), "the core is not one of the model");
  }
  if (!are_within(model, model.box_lower, kMaxCoordinate) ||
      !are_within(model, model.box_upper, kMaxCoordinate) ||
      !are_within(model, model.core_lower, kMaxCoreCoordinate) ||
      !are_within(model, model.core_upper, kMaxCoreCoordinate)) {
    return bad_model(offsetof(ModelRecord, box_lower), "the model's coordinates are out of range");
  }
  if (model.stray_count >= model.usable_triangles() && model.stray_count > 0) {
    return bad_model(offsetof(ModelRecord, stray_count), "all triangles are strays");
  }
  if (!(model.stray_edge >= 0 && model.stray_edge <= kMaxStrayEdge) ||
      (model.stray_count == 0 && !is_zero(model.stray_edge))) {
    return bad_model(offsetof(ModelRecord, stray_edge), "the edge of strays is out of range");
  }
  return {};
}

// The region must overlap the model's box, because at least one triangle touches both.
bool is_region(const ModelRecord& model) noexcept {
  if (!all_finite(model.region_lower) || !all_finite(model.region_upper)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    if (model.region_lower[axis] > model.region_upper[axis] ||
        model.region_lower[axis] > model.box_upper[axis] ||
        model.region_upper[axis] < model.box_lower[axis]) {
      return false;
    }
  }
  return true;
}

bool is_no_region(const ModelRecord& model) noexcept {
  constexpr ModelRecord kNothing{};
  return std::memcmp(model.region_lower, kNothing.region_lower, sizeof model.region_lower) == 0 &&
         std::memcmp(model.region_upper, kNothing.region_upper, sizeof model.region_upper) == 0 &&
         model.region_winding == 0;
}

Result<void> check_region(const ModelRecord& model) noexcept {
  if (model.has_region() ? !is_region(model) : !is_no_region(model)) {
    return bad_model(offsetof(ModelRecord, region_lower), "the region is not one of the model");
  }
  if (!model.has_side_layer() && model.region_winding != 0) {
    return bad_model(offsetof(ModelRecord, region_winding),
                     "a file without sides has a winding number");
  }
  if (model.has_region() && model.input_triangles < model.triangle_count) {
    return bad_model(offsetof(ModelRecord, input_triangles),
                     "a region has more triangles than the input");
  }
  // Each triangle and each cap contributes at most 1/2 to a winding number. The limit of
  // kMaxWinding keeps sums of winding numbers from overflowing.
  const std::uint64_t caps = std::min(model.cap_count, kMaxWinding);
  const auto maximum = static_cast<std::int64_t>(
      model.has_region() ? std::min(model.input_triangles, kMaxWinding) / 2 + caps / 2 + 1 : 0);
  if (model.region_winding > maximum || model.region_winding < -maximum) {
    return bad_model(offsetof(ModelRecord, region_winding),
                     "the winding number at the region's corner is out of range");
  }
  return {};
}

Result<void> check_side_rule(const ModelRecord& model) noexcept {
  if (!(model.openness >= 0 && model.openness <= 1)) {
    return bad_model(offsetof(ModelRecord, openness), "the surface's openness is not from 0 to 1");
  }
  if (model.side_rule != SideRule::kSolid && model.side_rule != SideRule::kSurface) {
    return bad_model(offsetof(ModelRecord, side_rule), "the rule for sides is unknown");
  }
  if (model.side_is_chosen > 1) {
    return bad_model(offsetof(ModelRecord, side_is_chosen), "the rule's choice is neither 0 nor 1");
  }
  if (model.side_is_chosen == 0 && model.unbalanced_edge_count == 0 &&
      model.side_rule != SideRule::kSolid) {
    return bad_model(offsetof(ModelRecord, side_rule), "a watertight surface is taken for a sheet");
  }
  if (model.without_sides > 1) {
    return bad_model(offsetof(ModelRecord, without_sides),
                     "the mark of a file without sides is neither 0 nor 1");
  }
  if (!all_zero(model.side_reserved)) {
    return bad_model(offsetof(ModelRecord, side_reserved),
                     "the reserved bytes of the rule for sides are not zero");
  }
  return {};
}

Result<void> check_mask(const ModelRecord& model) noexcept {
  if (!model.has_side_layer() && model.mask_page_count > 0) {
    return bad_model(offsetof(ModelRecord, mask_page_count), "a file without sides has a mask");
  }
  if ((model.mask_page_count > 0) != (model.mask_cell_count > 0) ||
      (model.mask_page_count == 0 && model.mask_levels > 0) || model.mask_levels > kMaxMaskLevel) {
    return bad_model(offsetof(ModelRecord, mask_cell_count), "the mask's size is out of range");
  }
  if (!all_zero(model.mask_reserved)) {
    return bad_model(offsetof(ModelRecord, mask_reserved),
                     "the mask's reserved bytes are not zero");
  }
  return {};
}

// An edge that is not balanced has at least one cap, unless the file has no side layer. A tree of
// caps has at least one block.
Result<void> check_caps(const ModelRecord& model) noexcept {
  const bool has_caps = model.cap_count > 0;
  const bool needs_caps = model.unbalanced_edge_count > 0 && model.has_side_layer();
  if (has_caps != needs_caps || has_caps != (model.cap_page_count > 0)) {
    return bad_model(offsetof(ModelRecord, cap_count),
                     "the caps are not those of the unbalanced edges");
  }
  if (model.triangle_id_bytes == 4 && model.cap_count > kMaxShortIndices) {
    return bad_model(offsetof(ModelRecord, cap_count),
                     "there are more caps than indices of 32 bits can count");
  }
  if (!are_counts_of_tree(model.cap_count, model.cap_node_count, model.cap_block_count)) {
    return bad_model(offsetof(ModelRecord, cap_node_count),
                     "the caps are not those of the unbalanced edges by their nodes and blocks");
  }
  if (!(model.cap_area >= 0 && model.cap_area <= kMaxCapArea) ||
      (!has_caps && !is_zero(model.cap_area))) {
    return bad_model(offsetof(ModelRecord, cap_area), "the area of the caps is out of range");
  }
  if (model.cap_height > kMaxHeight || (!has_caps && model.cap_height > 0)) {
    return bad_model(offsetof(ModelRecord, cap_height),
                     "the height of the tree of caps is out of range");
  }
  if (!all_zero(model.cap_reserved)) {
    return bad_model(offsetof(ModelRecord, cap_reserved),
                     "the reserved bytes of the caps are not zero");
  }
  return {};
}

// A grid of at least two points along each axis, whose lengths are those of a model frame.
bool is_field(const ModelRecord& model) noexcept {
  constexpr double kMinLength = 0x1p-40, kMaxLength = 4;
  if (!all_finite(model.field_lower)) return false;
  for (const std::uint32_t size : model.field_size) {
    if (size < 2) return false;
  }
  return model.field_step >= kMinLength && model.field_step <= kMaxLength &&
         model.field_quantum >= kMinLength && model.field_quantum <= kMaxLength;
}

Result<void> check_field(const ModelRecord& model) noexcept {
  constexpr ModelRecord kNothing{};
  const bool is_none =
      std::memcmp(model.field_lower, kNothing.field_lower, sizeof model.field_lower) == 0 &&
      std::memcmp(model.field_size, kNothing.field_size, sizeof model.field_size) == 0 &&
      is_zero(model.field_step) && is_zero(model.field_quantum);
  if (model.field_page_count > 0 ? !is_field(model) : !is_none) {
    return bad_model(offsetof(ModelRecord, field_lower), "the field's grid is out of range");
  }
  return {};
}

// Where a triangle is belongs to every attribute.
Result<void> check_attributes(const ModelRecord& model) noexcept {
  const std::uint8_t attributes = model.attributes;
  if ((attributes & ~kKnownAttributes) != 0 ||
      (attributes != 0 && (attributes & kAttributeLinks) == 0)) {
    return bad_model(offsetof(ModelRecord, attributes), "the kinds of attributes are unknown");
  }
  if (model.value_kind > ValueKind::kReal ||
      ((attributes & kAttributeValues) == 0 && model.value_kind != ValueKind::kUnsigned)) {
    return bad_model(offsetof(ModelRecord, value_kind), "the kind of values is unknown");
  }
  if (!all_zero(model.attribute_reserved)) {
    return bad_model(offsetof(ModelRecord, attribute_reserved),
                     "the reserved bytes of the attributes are not zero");
  }
  return {};
}

}  // namespace

Result<void> check_model(const ModelRecord& model) noexcept {
  if (const Result<void> checked = check_counts(model); !checked) return checked;
  if (!all_finite(model.box_lower) || !all_finite(model.box_upper)) {
    return bad_model(offsetof(ModelRecord, box_lower), "the model's box is not finite");
  }
  for (int axis = 0; axis < 3; ++axis) {
    if (model.box_lower[axis] > model.box_upper[axis]) {
      return bad_model(offsetof(ModelRecord, box_lower), "the model's box is inside out");
    }
  }
  if (!all_finite(model.centre)) {
    return bad_model(offsetof(ModelRecord, centre), "the model's centre is not finite");
  }
  if (!all_finite(model.sample)) {
    return bad_model(offsetof(ModelRecord, sample), "the model's sample point is not finite");
  }
  if (model.scale_exponent < -kMaxScaleExponent || model.scale_exponent > kMaxScaleExponent) {
    return bad_model(offsetof(ModelRecord, scale_exponent), "the model's scale is out of range");
  }
  if (model.vertex_kind != VertexKind::kFloat32 && model.vertex_kind != VertexKind::kFloat64) {
    return bad_model(offsetof(ModelRecord, vertex_kind), "the kind of vertices is unknown");
  }
  if (model.triangle_id_bytes != 4 && model.triangle_id_bytes != 8) {
    return bad_model(offsetof(ModelRecord, triangle_id_bytes),
                     "the width of triangle indices is neither 4 nor 8");
  }
  if (model.height > kMaxHeight) {
    return bad_model(offsetof(ModelRecord, height), "the tree's height is out of range");
  }
  if (!all_zero(model.reserved)) {
    return bad_model(offsetof(ModelRecord, reserved), "the model's reserved bytes are not zero");
  }
  if (const Result<void> checked = check_core(model); !checked) return checked;
  if (const Result<void> checked = check_side_rule(model); !checked) return checked;
  if (const Result<void> checked = check_mask(model); !checked) return checked;
  if (const Result<void> checked = check_region(model); !checked) return checked;
  if (const Result<void> checked = check_unbalanced_edges(model); !checked) return checked;
  if (const Result<void> checked = check_field(model); !checked) return checked;
  if (const Result<void> checked = check_attributes(model); !checked) return checked;
  return check_caps(model);
}

}  // namespace planetree::storage
