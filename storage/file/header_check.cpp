#include "storage/file/header_check.h"

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <cmath>
#include <cstring>
#include <iterator>

#include "storage/file/checksum.h"
#include "storage/file/page_codec.h"

namespace planetree::storage {
namespace {

constexpr int kMaxHeight = 96;
constexpr int kMaxMaskLevel = 19;
constexpr std::int32_t kMaxScaleExponent = 1200;
// Lengths in the model frame that bounds can be made of.
constexpr double kMaxStrayEdge = 0x1p60;
constexpr double kMaxCapArea = 0x1p1000;
constexpr std::uint64_t kMaxWinding = std::uint64_t{1} << 62;

Error damaged(std::uint64_t page, std::uint64_t offset, const char* cause) noexcept {
  return make_error(ErrorCode::kDamaged, page, offset,
                    "%s; restore the file from a copy or build it again", cause);
}

Error bad_header(std::size_t offset, const char* cause) noexcept {
  return damaged(Error::kNowhere, offset, cause);
}

Error bad_model(std::size_t offset, const char* cause) noexcept {
  return bad_header(offsetof(FileHeader, model) + offset, cause);
}

Error bad_entry(std::uint32_t page, const char* cause) noexcept {
  return damaged(page, table_end(page), cause);
}

bool all_zero(std::span<const std::uint8_t> bytes) noexcept {
  return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t byte) { return byte == 0; });
}

bool all_finite(std::span<const double> values) noexcept {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

Result<void> check_supported(const FileHeader& header) noexcept {
  if (header.version != kFormatVersion) {
    return make_error(ErrorCode::kUnsupported, Error::kNowhere, offsetof(FileHeader, version),
                      "the file has format version %d and this program reads version %d; use a "
                      "planetree of that version or build the file again",
                      header.version, kFormatVersion);
  }
  const std::uint64_t unknown = header.incompatible_features & ~kKnownIncompatibleFeatures;
  if (unknown != 0) {
    return make_error(ErrorCode::kUnsupported, Error::kNowhere,
                      offsetof(FileHeader, incompatible_features),
                      "the file needs feature bits %#" PRIx64
                      " that this program does not know; update planetree or build the file again",
                      unknown);
  }
  return {};
}

Result<void> check_lengths(const FileHeader& header, std::uint64_t actual_bytes) noexcept {
  if (header.file_bytes != actual_bytes) {
    return make_error(ErrorCode::kTruncated, Error::kNowhere,
                      std::min(header.file_bytes, actual_bytes),
                      "the file should have %" PRIu64 " bytes and has %" PRIu64
                      "; restore it from a copy or build it again",
                      header.file_bytes, actual_bytes);
  }
  if (header.page_count == 0) {
    return bad_header(offsetof(FileHeader, page_count), "the header states that there is no page");
  }
  // A page has at least one byte, so the file's length bounds the page table before memory is
  // allocated for it.
  if (table_end(header.page_count) + header.page_count + kHeaderBytes > header.file_bytes) {
    return bad_header(offsetof(FileHeader, page_count), "the page table does not fit in the file");
  }
  if (header.max_raw_bytes == 0 || header.max_raw_bytes > kMaxRawBytes) {
    return bad_header(offsetof(FileHeader, max_raw_bytes), "the largest raw page is out of range");
  }
  if (header.max_stored_bytes == 0 || header.max_stored_bytes > header.max_raw_bytes) {
    return bad_header(offsetof(FileHeader, max_stored_bytes),
                      "the largest stored page is out of range");
  }
  return {};
}

Result<void> check_entry(const FileHeader& header, std::uint32_t page,
                         const PageEntry& entry) noexcept {
  if (entry.codec != Codec::kStored && entry.codec != Codec::kLz4) {
    return bad_entry(page, "the page's codec is unknown");
  }
  if (entry.raw_bytes > header.max_raw_bytes) {
    return bad_entry(page, "the page's raw length is above the file's largest");
  }
  if (entry.stored_bytes == 0 || entry.stored_bytes > header.max_stored_bytes) {
    return bad_entry(page, "the page's stored length is zero or above the file's largest");
  }
  if (!lengths_are_plausible(entry.codec, entry.stored_bytes, entry.raw_bytes)) {
    return bad_entry(page, "the page's stored length cannot give its raw length");
  }
  return {};
}

bool key_less(const PageEntry& a, const PageEntry& b) noexcept {
  return a.octcode != b.octcode ? a.octcode < b.octcode : a.ordinal < b.ordinal;
}

// Checks that the pages fill the file. The sums cannot overflow: they have page_count terms of 32
// bits each.
Result<void> check_tiling(const FileHeader& header, std::span<const PageEntry> entries) noexcept {
  std::uint64_t offset = table_end(header.page_count);
  std::uint32_t max_raw_bytes = 0;
  std::uint32_t max_stored_bytes = 0;
  for (std::uint32_t page = 0; page < header.page_count; ++page) {
    const PageEntry& entry = entries[page];
    if (entry.offset != offset) {
      return bad_entry(page, "the page does not start where the one before ends");
    }
    if (const Result<void> checked = check_entry(header, page, entry); !checked) return checked;
    if (page > 0 && page != header.first_cap_page() && page != header.first_mask_page() &&
        !key_less(entries[page - 1], entry)) {
      return bad_entry(page, "the page's key does not follow the one before");
    }
    offset += entry.stored_bytes;
    max_raw_bytes = std::max(max_raw_bytes, entry.raw_bytes);
    max_stored_bytes = std::max(max_stored_bytes, entry.stored_bytes);
  }
  if (offset != header.file_bytes - kHeaderBytes) {
    return bad_entry(header.page_count - 1, "the pages do not end where the header's copy starts");
  }
  // Readers allocate buffers of these sizes, so they must not exceed what the pages need.
  if (max_raw_bytes != header.max_raw_bytes || max_stored_bytes != header.max_stored_bytes) {
    return bad_header(offsetof(FileHeader, max_raw_bytes),
                      "no page is as large as the header states");
  }
  return {};
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
  if (model.stray_count >= model.usable_triangles() && model.stray_count > 0) {
    return bad_model(offsetof(ModelRecord, stray_count), "all triangles are strays");
  }
  if (!(model.stray_edge >= 0 && model.stray_edge <= kMaxStrayEdge) ||
      (model.stray_count == 0 && model.stray_edge > 0)) {
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
  if (!all_zero(model.side_reserved)) {
    return bad_model(offsetof(ModelRecord, side_reserved),
                     "the reserved bytes of the rule for sides are not zero");
  }
  return {};
}

Result<void> check_mask(const ModelRecord& model) noexcept {
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

// An edge that is not balanced has at least one cap. A tree of caps has at least one block.
Result<void> check_caps(const ModelRecord& model) noexcept {
  const bool has_caps = model.cap_count > 0;
  if (has_caps != (model.unbalanced_edge_count > 0) || has_caps != (model.cap_page_count > 0) ||
      has_caps != (model.cap_block_count > 0) || (!has_caps && model.cap_node_count > 0)) {
    return bad_model(offsetof(ModelRecord, cap_count),
                     "the caps are not those of the unbalanced edges");
  }
  if (!(model.cap_area >= 0 && model.cap_area <= kMaxCapArea) ||
      (!has_caps && (model.cap_area > 0 || model.cap_root_link > 0))) {
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

}  // namespace

Result<void> check_header(const FileHeader& header, std::uint64_t actual_bytes) noexcept {
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) {
    return bad_header(offsetof(FileHeader, magic), "the header's first bytes are wrong");
  }
  if (const Result<void> checked = check_supported(header); !checked) return checked;
  if (header.header_bytes != kHeaderBytes) {
    return bad_header(offsetof(FileHeader, header_bytes), "the header's length is wrong");
  }
  if (const Result<void> checked = check_lengths(header, actual_bytes); !checked) return checked;
  if (!std::has_single_bit(header.page_bytes) || header.page_bytes < kMinPageBytes ||
      header.page_bytes > kMaxPageBytes) {
    return bad_header(offsetof(FileHeader, page_bytes),
                      "the page size is not a power of two from 4096 to 262144");
  }
  if (!all_zero(header.reserved)) {
    return bad_header(offsetof(FileHeader, reserved), "the header's reserved bytes are not zero");
  }
  if (header.model.mask_page_count >= header.page_count ||
      header.model.cap_page_count >= header.page_count - header.model.mask_page_count) {
    return bad_model(offsetof(ModelRecord, mask_page_count),
                     "there are only pages of the mask and of caps");
  }
  return check_model(header.model);
}

Result<void> check_model(const ModelRecord& model) noexcept {
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
  return check_caps(model);
}

Result<void> check_table(const FileHeader& header, std::span<const PageEntry> entries) noexcept {
  if (entries.size() != header.page_count || table_hash(entries) != header.table_hash) {
    return damaged(Error::kNowhere, kHeaderBytes, "the page table's checksum is wrong");
  }
  const Hash128 id = content_id(entries, header.content_id[0]);
  if (id != Hash128{header.content_id[0], header.content_id[1]}) {
    return damaged(Error::kNowhere, offsetof(FileHeader, content_id),
                   "the content id does not follow from the page table");
  }
  return check_tiling(header, entries);
}

}  // namespace planetree::storage
