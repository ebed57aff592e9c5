#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <new>
#include <span>

#include "octree/geometry/region.h"
#include "octree/mask/mask_lookup.h"
#include "octree/mask/side_grid.h"
#include "octree/nearest/nearest.h"
#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/stats.h"
#include "query/answer/scale.h"
#include "query/serve/fetch_requests.h"
#include "query/serve/pager.h"
#include "query/serve/query_arena.h"
#include "storage/system/file_calls.h"

namespace planetree::query {

class BatchCrew;
class FetchCrew;

/// Where a model can be taken apart: the system, so that disks can fail or stand still; its
/// threads, so that a test can do what they do, step by step; and which pages it keeps, so that
/// ways to choose can be compared.
struct ModelSeams {
  storage::FileCalls& calls = storage::FileCalls::real();  ///< must outlive the model
  bool starts_fetching = true;
  cache::Policy policy = cache::Policy::kClock;
};

/// What stands behind a Model; in the AskingMemory that it holds itself.
class ModelState {
 public:
  ~ModelState();
  static void* operator new(std::size_t) = delete;
  static void operator delete(ModelState* state, std::destroying_delete_t) noexcept;

  static Result<std::unique_ptr<ModelState>> open(const std::filesystem::path& path,
                                                  const OpenOptions& options,
                                                  const ModelSeams& seams = {});
  static Result<Model> open_model(const std::filesystem::path& path, const OpenOptions& options,
                                  const ModelSeams& seams = {});
  static const ModelState& of(const Model& model) noexcept { return *model.state_; }

  const ModelInfo& info() const noexcept { return info_; }
  Stats stats() const noexcept;
  const octree::TreeFacts& tree() const noexcept { return tree_; }
  const octree::MaskFacts& mask() const noexcept { return mask_; }
  const octree::ColourMap& colours() const noexcept { return colours_; }
  /// Where the file knows all of the surface.
  const octree::Region& region() const noexcept { return region_; }
  /// A point in it, and the winding number there; of a watertight model of a region.
  const octree::Point& region_corner() const noexcept { return region_corner_; }
  std::int64_t region_winding() const noexcept { return region_winding_; }
  const Scale& scale() const noexcept { return scale_; }
  Result<cache::Reader> claim_reader() const noexcept { return pager_->cache().claim_reader(); }
  cache::PageCache& cache() const noexcept { return pager_->cache(); }
  /// How asks wait for pages; and how fetch threads do.
  cache::FetchTerms asking_terms() const noexcept { return {!fetchers_, wait_limit_}; }
  cache::FetchTerms fetching_terms() const noexcept { return {true, wait_limit_}; }
  /// Null where batches are answered by the caller's thread alone.
  BatchCrew* crew() const noexcept { return crew_.get(); }
  /// Of the probe whose reader has this place.
  Wishes& wishes(std::uint32_t place) const noexcept { return asking_.wishes[place]; }
  /// Its notes of pages.
  TouchLog touch_log(std::uint32_t place) const noexcept {
    if (asking_.traces.empty()) return {nullptr, nullptr};
    return {&asking_.traces[place], asking_.marks.data()};
  }
  /// See Model::take_touches.
  std::size_t take_touches(std::span<PageTouch> touches) const noexcept;
  /// For the ProbeState whose reader has this place.
  void* probe_room(std::uint32_t place) const noexcept { return asking_.probe_room(place); }
  std::uint32_t reader_count() const noexcept {
    return static_cast<std::uint32_t>(asking_.wishes.size());
  }
  /// Any thread.
  void count_degraded() const noexcept { degraded_.fetch_add(1, std::memory_order_relaxed); }

 private:
  ModelState(std::unique_ptr<Pager> pager, std::chrono::milliseconds wait_limit);
  Result<void> fill_colours();
  Result<void> start_crews(const OpenOptions& options, const ModelSeams& seams);

  std::unique_ptr<Pager> pager_;
  const AskingMemory::Parts asking_;
  ModelInfo info_;
  octree::TreeFacts tree_;
  octree::MaskFacts mask_;
  octree::ColourMap colours_;
  octree::Region region_;
  octree::Point region_corner_ = octree::Point::Zero();
  std::int64_t region_winding_ = 0;
  Scale scale_;
  std::chrono::milliseconds wait_limit_;
  mutable std::atomic<std::uint64_t> degraded_{0};
  // Last: their probes are the model's.
  std::unique_ptr<BatchCrew> crew_;
  std::unique_ptr<FetchCrew> fetchers_;
};

}  // namespace planetree::query
