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

class BatchThreads;
class FetchThreads;

/// Where a model can be taken apart: the system, so that disks can fail or stand still; its
/// threads, so that a test can do what they do, step by step; and which pages it keeps, so that
/// ways to choose can be compared.
struct ModelSeams {
  storage::FileCalls& calls = storage::FileCalls::real();  ///< must outlive the model
  bool starts_fetching = true;
  cache::Policy policy = cache::Policy::kClock;
};

/// What stands behind a Model; in the QueryArena that it holds itself.
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
  const octree::TreeInfo& tree() const noexcept { return tree_; }
  const octree::MaskInfo& mask() const noexcept { return mask_; }
  const octree::SideGrid& side_grid() const noexcept { return side_grid_; }
  /// Where the file knows all of the surface.
  const octree::Region& region() const noexcept { return region_; }
  /// A point in it, and the winding number there; of a watertight model of a region.
  const octree::Point& region_corner() const noexcept { return region_corner_; }
  std::int64_t region_winding() const noexcept { return region_winding_; }
  const Scale& scale() const noexcept { return scale_; }
  Result<cache::Reader> claim_reader() const noexcept { return pager_->cache().claim_reader(); }
  cache::PageCache& cache() const noexcept { return pager_->cache(); }
  /// How asks wait for pages; and how fetch threads do.
  cache::FetchTerms query_terms() const noexcept { return {!fetch_threads_, wait_limit_}; }
  cache::FetchTerms fetcher_terms() const noexcept { return {true, wait_limit_}; }
  /// Null where batches are answered by the caller's thread alone.
  BatchThreads* batch_threads() const noexcept { return batch_threads_.get(); }
  /// Of the probe whose reader has this place.
  FetchRequests& fetch_requests(std::uint32_t index) const noexcept {
    return query_arena_.fetch_requests[index];
  }
  /// Its notes of pages.
  PageTraceWriter page_trace_writer(std::uint32_t index) const noexcept {
    if (query_arena_.traces.empty()) return {nullptr, nullptr};
    return {&query_arena_.traces[index], query_arena_.marks.data()};
  }
  /// See Model::drain_page_trace.
  std::size_t drain_page_trace(std::span<PageAccess> accesses) const noexcept;
  /// For the ProbeState whose reader has this place.
  void* storage_of_probe(std::uint32_t index) const noexcept {
    return query_arena_.storage_of_probe(index);
  }
  std::uint32_t reader_count() const noexcept {
    return static_cast<std::uint32_t>(query_arena_.fetch_requests.size());
  }
  /// Any thread.
  void count_degraded() const noexcept { degraded_.fetch_add(1, std::memory_order_relaxed); }

 private:
  ModelState(std::unique_ptr<Pager> pager, std::chrono::milliseconds wait_limit);
  Result<void> fill_side_grid();
  Result<void> start_threads(const OpenOptions& options, const ModelSeams& seams);

  std::unique_ptr<Pager> pager_;
  const QueryArena::Parts query_arena_;
  ModelInfo info_;
  octree::TreeInfo tree_;
  octree::MaskInfo mask_;
  octree::SideGrid side_grid_;
  octree::Region region_;
  octree::Point region_corner_ = octree::Point::Zero();
  std::int64_t region_winding_ = 0;
  Scale scale_;
  std::chrono::milliseconds wait_limit_;
  mutable std::atomic<std::uint64_t> degraded_{0};
  // Last: their probes are the model's.
  std::unique_ptr<BatchThreads> batch_threads_;
  std::unique_ptr<FetchThreads> fetch_threads_;
};

}  // namespace planetree::query
