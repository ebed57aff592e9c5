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

/// What stands behind a Probe; in the model's AskingMemory, but for those of fetch threads.
class ProbeState {
 public:
  /// In the room that the reader's place has.
  static std::unique_ptr<ProbeState> create(const ModelState& model, cache::Reader reader,
                                            std::unique_ptr<BatchRoom> batch_room = nullptr) {
    void* room = model.probe_room(reader.place());
    return std::unique_ptr<ProbeState>(
        ::new (room) ProbeState(model, std::move(reader), std::move(batch_room)));
  }
  static void* operator new(std::size_t) = delete;
  // The reader goes last: with it, the room is another's.
  static void operator delete(ProbeState* state, std::destroying_delete_t) noexcept {
    state->~ProbeState();
  }

  ProbeState(const ModelState& model, cache::Reader reader,
             std::unique_ptr<BatchRoom> batch_room = nullptr) noexcept
      : model_(model),
        reader_(std::move(reader)),
        touches_(model.touch_log(reader_.place())),
        batch_room_(std::move(batch_room)) {}

  const ModelState& model() const noexcept { return model_; }
  cache::Reader& reader() noexcept { return reader_; }

  octree::Vicinity& vicinity() noexcept { return vicinity_; }
  SideMemory& side_memory() noexcept { return side_memory_; }

  /// Where it says which pages it would like.
  Wishes& wishes() noexcept { return model_.wishes(reader_.place()); }
  /// The last nearest triangle, for asks that may find none; nothing before the first of
  /// Wait::kNever.
  octree::NearestAnswer& last_nearest() noexcept { return last_nearest_; }
  TouchLog& touches() noexcept { return touches_; }
  /// The parts last asked for.
  std::uint32_t& last_parts() noexcept { return last_parts_; }

  /// Whether the last look at the colours told a side, so that the next may.
  bool& colours_told() noexcept { return colours_told_; }
  /// Whether the last side that came with a distance took a search of the mask.
  bool& searched_side() noexcept { return searched_side_; }

  /// For batches; null in the probes of a BatchCrew.
  BatchRoom* batch_room() noexcept { return batch_room_.get(); }

 private:
  const ModelState& model_;
  cache::Reader reader_;
  TouchLog touches_;
  // Where there is room before what begins on a cache line.
  std::unique_ptr<BatchRoom> batch_room_;
  std::uint32_t last_parts_ = kAllParts;
  bool colours_told_ = true;
  bool searched_side_ = false;
  octree::Vicinity vicinity_;
  SideMemory side_memory_;
  octree::NearestAnswer last_nearest_;
};

}  // namespace planetree::query
