#pragma once

#include <cstdint>

#include "octree/page/frame.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {

/// Calls call(block, link) for every block of a sample, in the order of links.
template <class Call>
void each_block(const SampleTree& sample, const SamplePages& pages, const Call& call) {
  const std::uint32_t page_bytes = sample.plan.page_bytes;
  const LinkFormat links(page_bytes);
  for (std::uint32_t page = 0; page < pages.size(); ++page) {
    const SampleFrame& frame = pages.frame(page);
    const auto* starts = reinterpret_cast<const std::uint64_t*>(frame.data() + kSlotBytes);
    for (std::uint32_t slot = frame.header().first_block_slot; slot < page_bytes / kSlotBytes;
         ++slot)
      if ((starts[slot / 64] >> slot % 64 & 1) != 0)
        call(BlockView(frame.data() + slot * kSlotBytes, sample.shape),
             links.make(true, page, slot));
  }
}

}  // namespace planetree::octree
