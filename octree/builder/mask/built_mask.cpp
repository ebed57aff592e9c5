#include "octree/builder/mask/built_mask.h"

#include <algorithm>
#include <utility>

#include "octree/builder/mask/mask_encoder.h"

namespace planetree::octree {

Result<void> BuiltMask::build(const MaskSectors& sectors, const TriangleRuns& runs,
                              const BuiltTrees& trees, const SectorCall& done) {
  sectors_.resize(sectors.all().size());
  const bool alone = sectors_.size() == 1;
  const auto known = [this](std::size_t at) -> const SectorRoot* {
    const auto found = known_.find(static_cast<std::uint32_t>(at));
    return found != known_.end() ? &found->second.root : nullptr;
  };
  const auto take = [&](std::size_t at, const MaskTree& mask,
                        const SectorRoot& root) -> Result<void> {
    auto built = spill_sector(mask, {sectors.all()[at].cell, !alone});
    if (!built) return built.error();
    built->root = root;
    sectors_[at].built = *std::move(built);
    return done(static_cast<std::uint32_t>(at), sectors_[at].built);
  };
  auto above = build_mask(sectors, runs, trees, known, take);
  if (!above) return above.error();
  for (std::uint32_t at = 0; at < sectors_.size(); ++at)
    if (known(at) && sectors.all()[at].touched) sectors_[at].built = std::move(known_[at]);
  count_cells();
  if (!alone) {
    above_ = *std::move(above);
    above_plan_ = plan_mask(above_, page_bytes_);
    // The roots of the sectors are counted with the cells above.
    cell_count_ += above_.entries.size();
  }
  number_pages();
  const MaskLinkFormat links(page_bytes_);
  if (pages_.size() > links.max_pages())
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "%zu mask pages, more than links can address; build with a larger page "
                      "size",
                      pages_.size());
  link_sectors();
  return {};
}

Result<BuiltSector> BuiltMask::spill_sector(const MaskTree& mask, const MaskRoot& root) {
  BuiltSector sector;
  const MaskPlan plan = plan_mask(mask, page_bytes_, root);
  const MaskEncoder encoder(mask, plan, 0, float64_);
  for (const PlannedMaskPage& page : plan.pages) {
    const auto spilled = spill_page(page.octcode, encoder.encode(page.number), file_);
    if (!spilled) return spilled.error();
    sector.pages.push_back(*spilled);
  }
  sector.cell_count = mask.entries.size() - (root.apart ? 1 : 0);
  sector.levels = mask.levels;
  return sector;
}

void BuiltMask::count_cells() {
  for (const SectorPages& sector : sectors_) {
    cell_count_ += sector.built.cell_count;
    levels_ = std::max(levels_, sector.built.levels);
  }
}

// Families above the sectors divide larger cells, so that their pages come first.
void BuiltMask::number_pages() {
  for (std::uint32_t i = 0; i < above_plan_.pages.size(); ++i)
    pages_.push_back({above_plan_.pages[i].octcode, kAbove, i});
  for (std::uint32_t at = 0; at < sectors_.size(); ++at) {
    sectors_[at].numbers.resize(sectors_[at].built.pages.size());
    for (std::uint32_t i = 0; i < sectors_[at].built.pages.size(); ++i)
      pages_.push_back({sectors_[at].built.pages[i].octcode, at, i});
  }
  std::sort(pages_.begin(), pages_.end(),
            [](const Page& a, const Page& b) { return a.octcode < b.octcode; });
}

void BuiltMask::link_sectors() {
  std::vector<std::uint32_t> numbers(above_plan_.pages.size());
  for (std::uint32_t number = 0; number < pages_.size(); ++number) {
    const Page& page = pages_[number];
    (page.sector == kAbove ? numbers : sectors_[page.sector].numbers)[page.index] = number;
  }
  for (PlannedMaskPage& page : above_plan_.pages) page.number = numbers[page.number];
  for (std::size_t i = 0; i < above_.entries.size(); ++i) {
    const MaskEntry& entry = above_.entries[i];
    StoredLink& family = above_plan_.families[i];
    if (entry.kind == MaskEntry::Kind::kSector)
      family = {sectors_[entry.first].numbers[0], 0};
    else if (entry.kind == MaskEntry::Kind::kNode && entry.grey != 0)
      family.page = numbers[family.page];
  }
}

Result<FilePage> BuiltMask::encode(std::uint32_t number, std::uint32_t first_page) const {
  const Page& page = pages_[number];
  if (page.sector != kAbove) {
    const SectorPages& sector = sectors_[page.sector];
    auto raw = read_spilled_page(sector.built.pages[page.index], file_, first_page + number,
                                 [&](std::uint32_t index) { return sector.numbers[index]; });
    if (!raw) return raw.error();
    return FilePage{page.octcode, 0, *std::move(raw)};
  }
  const MaskEncoder encoder(above_, above_plan_, first_page, float64_);
  return FilePage{page.octcode, 0, encoder.encode(page.index).bytes};
}

}  // namespace planetree::octree
