#pragma once

#include <functional>
#include <vector>

#include "octree/page/mask_frame.h"
#include "octree/page/page_decoder.h"
#include "tests/octree/page/raw_mask_page.h"

namespace planetree::octree {

/// One change to an honest page of random_mask(), and the sentence with which it is refused then.
struct MaskCorruption {
  const char* sentence;
  std::function<void(RawMaskPage&, PageInfo&)> corrupt;
};

/// To reach every sentence there is. The page has leaves of all kinds, and pages below it; lists
/// as long as they may be would not fit it.
std::vector<MaskCorruption> all_mask_corruptions();

/// Those of them that are of lists of blocks.
std::vector<MaskCorruption> mask_list_corruptions();

}  // namespace planetree::octree
