#pragma once

#include <cstddef>
#include <memory>
#include <new>
#include <utility>

#include "cache/reader.h"
#include "query/answer/side_cache.h"
#include "query/model_state.h"
#include "query/serve/batch_order.h"
#include "query/serve/fetch_requests.h"

namespace planetree::query {

/// What stands behind a Probe; in the model's QueryArena, but for those of fetch threads.
class ProbeState {
 public:
  /// In the room that the reader's place has.
  static std::unique_ptr<ProbeState> create(const ModelState& model, cache::Reader reader,
                                            std::unique_ptr<BatchBuffers> batch_buffers = nullptr) {
    void* storage = model.storage_of_probe(reader.index());
    return std::unique_ptr<ProbeState>(
        ::new (storage) ProbeState(model, std::move(reader), std::move(batch_buffers)));
  }
  static void* operator new(std::size_t) = delete;
  // The reader goes last: with it, the room is another's.
  static void operator delete(ProbeState* state, std::destroying_delete_t) noexcept {
    state->~ProbeState();
  }

  ProbeState(const ModelState& model, cache::Reader reader,
             std::unique_ptr<BatchBuffers> batch_buffers = nullptr) noexcept
      : model_(model),
        reader_(std::move(reader)),
        page_trace_(model.page_trace_writer(reader_.index())),
        batch_buffers_(std::move(batch_buffers)) {}

  const ModelState& model() const noexcept { return model_; }
  cache::Reader& reader() noexcept { return reader_; }

  octree::CoherenceCache& coherence_cache() noexcept { return coherence_cache_; }
  SideCache& side_cache() noexcept { return side_cache_; }

  /// Where it says which pages it would like.
  FetchRequests& fetch_requests() noexcept { return model_.fetch_requests(reader_.index()); }
  /// The last nearest triangle, for asks that may find none; nothing before the first of
  /// Wait::kNever.
  octree::NearestAnswer& last_nearest() noexcept { return last_nearest_; }
  PageTraceWriter& touches() noexcept { return page_trace_; }
  /// The parts last asked for.
  std::uint32_t& last_parts() noexcept { return last_parts_; }

  /// Whether the last look at the colours told a side, so that the next may.
  bool& side_grid_answered() noexcept { return side_grid_answered_; }
  /// Whether the last side that came with a distance took a search of the mask.
  bool& searched_side() noexcept { return searched_side_; }

  /// For batches; null in the probes of a BatchThreads.
  BatchBuffers* batch_buffers() noexcept { return batch_buffers_.get(); }

 private:
  const ModelState& model_;
  cache::Reader reader_;
  PageTraceWriter page_trace_;
  // Where there is room before what begins on a cache line.
  std::unique_ptr<BatchBuffers> batch_buffers_;
  std::uint32_t last_parts_ = kAllParts;
  bool side_grid_answered_ = true;
  bool searched_side_ = false;
  octree::CoherenceCache coherence_cache_;
  SideCache side_cache_;
  octree::NearestAnswer last_nearest_;
};

}  // namespace planetree::query
