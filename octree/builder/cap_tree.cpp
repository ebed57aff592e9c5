#include "octree/builder/cap_tree.h"

#include <limits>
#include <utility>

#include "octree/builder/job/parallel.h"
#include "octree/builder/sort/morton_order.h"
#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Number of caps that are sorted at a time.
constexpr std::uint32_t kCapsAtOnce = 1 << 16;

}  // namespace

CapTree::CapTree(const ModelFrame& frame, const BlockShape& shape, std::uint32_t page_bytes,
                 std::uint64_t held_bytes, storage::SpillFile& file, storage::SpillFile& pages)
    : frame_(frame),
      page_bytes_(page_bytes),
      pages_(pages),
      shape_(shape),
      runs_(shape.float64, held_bytes, file),
      batch_(shape.float64) {
  shape_.moments = true;
}

Result<void> CapTree::close(CapChain& boundary, RegionCut& cut) {
  const auto closed = boundary.close([&](const Triangle& cap) { return add(cap, cut); });
  if (!closed) return closed;
  return runs_.add(std::exchange(batch_, Triangles(shape_.float64)));
}

Result<void> CapTree::add(const Triangle& cap, RegionCut& cut) {
  if (!shape_.wide_ids && count_ > std::numeric_limits<std::uint32_t>::max())
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "the surface has more unbalanced edges than a file of 32-bit indices can "
                      "close; join its vertices, or build parts of it");
  cut.add_cap(cap);
  area_ += area_of(cap);
  batch_.add({morton_code_of(cap, frame_.core_lower()), count_++}, cap);
  if (batch_.size() < kCapsAtOnce) return {};
  return runs_.add(std::exchange(batch_, Triangles(shape_.float64)));
}

void CapTree::resume(const CapWork& work) {
  count_ = work.count;
  area_ = work.area;
  runs_.add_extent(work.runs);
}

Result<void> CapTree::build(MaskSectors& sectors, std::uint64_t max_triangles) {
  if (count_ == 0) return {};
  auto above = cut_chunks(runs_, false, max_triangles);
  if (!above) return above.error();
  above_ = *std::move(above);
  chunks_.resize(above_.chunks.size());
  return for_each_in_parallel(chunks_.size(), [&](std::size_t at) -> Result<void> {
    const auto caps = runs_.read(above_.chunks[at].from, above_.chunks[at].to);
    if (!caps) return caps.error();
    // No sector has caps of its own: they visit those that they touch, as strays do.
    Triangles visitors(shape_.float64);
    for (std::uint32_t i = 0; i < caps->size(); ++i)
      visitors.add({caps->code(i) | kStrayCode, kCapIndex | caps->index(i)}, caps->corners(i));
    if (const auto added = sectors.add(visitors); !added) return added.error();
    auto built =
        build_chunk(*caps, chunks_.size() == 1, frame_.centre(), shape_, page_bytes_, pages_);
    if (!built) return built.error();
    chunks_[at] = *std::move(built);
    return {};
  });
}

Result<void> CapTree::number_pages(std::uint32_t first_page) {
  if (count_ == 0) return {};
  tree_.emplace(frame_, above_, chunks_, shape_, page_bytes_, pages_, first_page);
  return tree_->check();
}

void CapTree::describe(storage::ModelRecord& model) const {
  if (!tree_) return;
  model.cap_count = count_;
  model.cap_area = area_;
  model.cap_node_count = tree_->node_count();
  model.cap_block_count = tree_->block_count();
  model.cap_height = static_cast<std::uint8_t>(tree_->height());
  model.cap_page_count = tree_->pages().size();
}

}  // namespace planetree::octree
