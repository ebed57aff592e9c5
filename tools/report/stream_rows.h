#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "octree/attributes/attribute_page.h"
#include "octree/field/field_page.h"
#include "octree/page/mask_streams.h"
#include "octree/page/page_streams.h"

namespace planetree::tools {

/// What a stream of a page holds.
enum class StreamGroup : std::uint8_t {
  kHead,
  kNodes,
  kBlocks,
  kCorners,
  kVertices,
  kIds,
  kMask,        ///< streams of mask pages other than lists
  kMaskLists,   ///< lists of blocks in mask pages
  kField,       ///< streams of field pages
  kAttributes,  ///< streams of attribute pages
};
inline constexpr std::size_t kStreamGroupCount = 10;
/// The group's name in reports.
[[nodiscard]] std::string_view group_name(StreamGroup group);

/// One stream of a page's raw bytes, with its name in format-spec. Names of mask pages that
/// distance pages have too begin with mask_.
struct StreamRow {
  std::string_view name;
  StreamGroup group = StreamGroup::kHead;
  std::uint64_t elements = 0;
  std::uint64_t bytes = 0;
};

/// All streams of a distance page in stored order, the page head first. Names and order are the
/// same for all distance pages of a file.
[[nodiscard]] std::vector<StreamRow> stream_rows(const octree::RawStreams& streams,
                                                 const octree::BlockShape& shape);
/// The same for a field page.
[[nodiscard]] std::vector<StreamRow> stream_rows(const octree::FieldPageHead& head);
/// The same for an attribute page.
[[nodiscard]] std::vector<StreamRow> stream_rows(const octree::AttributePageHead& head,
                                                 octree::AttributeShape shape);
/// The same for a mask page.
[[nodiscard]] std::vector<StreamRow> stream_rows(const octree::MaskStreams& streams,
                                                 const octree::BlockShape& shape);

}  // namespace planetree::tools
