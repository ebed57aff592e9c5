#pragma once

#include <functional>
#include <vector>

#include "octree/page/mask_frame.h"
#include "octree/page/page_decoder.h"
#include "tests/octree/page/raw_mask_page.h"

namespace planetree::octree {

/// One change to a valid page of random_mask(), and the message with which the page is then
/// refused.
struct MaskCorruption {
  const char* sentence;
  std::function<void(RawMaskPage&, PageInfo&)> corrupt;
};

/// Corruptions that reach every message. The page must have leaves of all kinds and pages below it,
/// and lists of the maximum length must not fit it.
std::vector<MaskCorruption> all_mask_corruptions();

/// The subset of them that concerns lists of blocks.
std::vector<MaskCorruption> mask_list_corruptions();

}  // namespace planetree::octree
