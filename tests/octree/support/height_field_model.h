#pragma once

#include <cstring>
#include <functional>
#include <vector>

#include "octree/builder/mask/built_mask.h"
#include "octree/builder/mask/height_field_finder.h"
#include "octree/builder/mask/tree_frames.h"
#include "octree/builder/surface/region_cut.h"
#include "octree/page/frame.h"
#include "tests/octree/builder/chunked_tree.h"
#include "tests/octree/support/sample_mask.h"

namespace planetree::octree {

/// A watertight model with its tree and mask, built up to the writing of its file.
struct HeightFieldModel {
  explicit HeightFieldModel(const Soup& soup, storage::SpillFile& file = spill_file())
      : tree(soup, 200, 4096, file),
        mask(4096, tree.shape.float64, file),
        info(tree.tree->info()),
        surface(tree.mesh) {
    RegionCut cut(tree.mesh.frame, {}, nullptr);
    if (!cut.add(tree.mesh)) std::abort();
    MaskSectors sectors(tree.mesh.lower(), {}, cut.found().winding, tree.shape.float64, 1 << 20,
                        spill_file());
    if (!sectors.divide(*tree.runs, nullptr, false, 2000) || !sectors.add(tree.mesh) ||
        !mask.build(sectors, *tree.runs, tree.tree.get(),
                    [](std::uint32_t, const BuiltSector&) { return Result<void>(); }))
      std::abort();
    mask_info = {4096, tree.tree->pages().size(), mask.size(), tree.mesh.lower()};
  }

  /// Calls look(block, page) for every block. The block is valid during the call only.
  void each_block(const std::function<void(const BlockView&, std::uint32_t)>& look) const {
    for (std::uint32_t page = 0; page < tree.tree->pages().size(); ++page) {
      SampleFrame frame(4096);
      const auto raw = tree.tree->pages().encode(page);
      if (!raw || !decode_page(raw->bytes, tree.tree->info_of_page(page), frame.bytes()))
        std::abort();
      std::size_t slot = frame.header().first_block_slot;
      for (std::size_t i = 0; i < frame.header().block_count; ++i) {
        const BlockView block(frame.data() + slot * kSlotBytes, info.shape);
        look(block, page);
        slot += block.slots();
      }
    }
  }

  ChunkedTree tree;
  BuiltMask mask;
  TreeInfo info;
  MaskInfo mask_info;
  Surface surface;
};

}  // namespace planetree::octree
