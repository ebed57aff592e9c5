#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "octree/page/mask_streams.h"
#include "octree/page/raw_streams.h"

namespace planetree::tools {

/// What a stream of a page is for.
enum class StreamGroup : std::uint8_t {
  kHead,
  kNodes,
  kBlocks,
  kCorners,
  kVertices,
  kIds,
  kMask,       ///< of mask pages, but
  kMaskLists,  ///< of lists of blocks
};
inline constexpr std::size_t kStreamGroupCount = 8;
[[nodiscard]] std::string_view group_name(StreamGroup group);

/// One stream of a page's raw bytes, as format-spec names it; those of mask pages whose names
/// distance pages have too begin with mask_.
struct StreamRow {
  std::string_view name;
  StreamGroup group = StreamGroup::kHead;
  std::uint64_t elements = 0;
  std::uint64_t bytes = 0;
};

/// All streams in the order in which they lie, the page head first; the rows'
/// names and order are the same for every page of one file.
[[nodiscard]] std::vector<StreamRow> stream_rows(const octree::RawStreams& streams,
                                                 const octree::BlockShape& shape);
/// The same of a mask page.
[[nodiscard]] std::vector<StreamRow> stream_rows(const octree::MaskStreams& streams,
                                                 const octree::BlockShape& shape);

}  // namespace planetree::tools
