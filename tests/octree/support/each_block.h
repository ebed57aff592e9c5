#pragma once

#include <cstdint>

#include "octree/page/block_table.h"
#include "octree/page/frame.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {

/// Calls call(block, link) for every block of a sample, in the order of links, which are numbered.
template <class Call>
void each_block(const SampleTree& sample, const SamplePages& pages, const Call& call) {
  const LinkFormat links = LinkFormat::numbered(sample.plan.page_bytes);
  for (std::uint32_t page = 0; page < pages.size(); ++page) {
    const SampleFrame& frame = pages.frame(page);
    for (std::uint16_t number = 0; number < frame.header().block_count; ++number) {
      const std::uint32_t slot = BlockTable(frame.data()).slot(number);
      call(BlockView(frame.data() + slot * kSlotBytes, sample.shape),
           links.make_block({page, number}));
    }
  }
}

}  // namespace planetree::octree
