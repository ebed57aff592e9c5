#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "octree/builder/mask/mask_build.h"
#include "octree/builder/mask/mask_plan.h"
#include "octree/builder/tree/page_appender.h"
#include "octree/builder/tree/spilled_page.h"
#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::octree {

/// The mask of a sector, with its pages spilled.
struct BuiltSector {
  std::vector<SpilledPage> pages;  ///< the first begins with the root's family
  std::uint64_t cell_count = 0;
  unsigned levels = 0;
  SectorRoot root;
};

/// The pages of a mask: the spilled pages of its sectors, and the pages of the cells above them. A
/// mask of one sector has the pages of that sector only.
class BuiltMask {
 public:
  /// float64  planes are stored in the same type as vertices.
  /// file     receives the pages of the sectors; must outlive this.
  BuiltMask(std::uint32_t page_bytes, bool float64, storage::SpillFile& file)
      : page_bytes_(page_bytes), float64_(float64), file_(file) {}

  /// Takes a sector that was built before, with its pages in the file. Call it before build().
  void resume(std::uint32_t number, BuiltSector sector) {
    known_.insert_or_assign(number, std::move(sector));
  }

  /// Called on any thread with each sector that triangles touch, once it is built.
  using SectorCall = std::function<Result<void>(std::uint32_t number, const BuiltSector& sector)>;

  /// Builds the mask except for the sectors that were resumed. Call it once.
  ///
  /// trees   see build_mask().
  /// errors  those of build_mask(), SpillFile and `done`; kBadArgument: more pages than links of 32
  ///         bits can address, 2^19 for pages of 64 KiB.
  Result<void> build(const MaskSectors& sectors, const TriangleRuns& runs, const BuiltTrees& trees,
                     const SectorCall& done);

  std::uint32_t size() const { return static_cast<std::uint32_t>(pages_.size()); }
  std::uint64_t cell_count() const { return cell_count_; }
  unsigned levels() const { return levels_; }

  /// Makes a page, given its number within the mask. Any number of threads.
  /// first_page  number of the mask's first page in the file.
  Result<FilePage> encode(std::uint32_t number, std::uint32_t first_page) const;

 private:
  static constexpr std::uint32_t kAbove = ~std::uint32_t{0};
  struct SectorPages {
    BuiltSector built;
    std::vector<std::uint32_t> numbers;  // page numbers within the mask
  };
  struct Page {
    std::uint64_t octcode = 0;
    std::uint32_t sector = kAbove;
    std::uint32_t index = 0;  // among the pages of the sector
  };

  Result<BuiltSector> spill_sector(const MaskTree& mask, const MaskRoot& root);
  void count_cells();
  void number_pages();
  void link_sectors();
  const std::uint32_t page_bytes_;
  const bool float64_;
  storage::SpillFile& file_;
  std::map<std::uint32_t, BuiltSector> known_;
  std::vector<SectorPages> sectors_;
  MaskTree above_;
  MaskPlan above_plan_;
  std::vector<Page> pages_;
  std::uint64_t cell_count_ = 0;
  unsigned levels_ = 0;
};

}  // namespace planetree::octree
