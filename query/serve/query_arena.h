#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "cache/prefaulted_memory.h"
#include "planetree/error.h"
#include "query/serve/fetch_requests.h"
#include "query/serve/page_trace.h"

namespace planetree::query {

/// What asks touch besides frames and page map: the model's own facts, the colours of its mask,
/// what each probe remembers and wishes, and its trace. Claimed when a model is opened, so that no
/// ask faults a page in.
class QueryArena {
 public:
  struct Needs {
    std::uint32_t readers = 0;  ///< most probes, those of the model's threads among them
    std::uint64_t colour_bytes = 0;
    std::uint64_t page_trace_capacity = 0;  ///< of each reader; 0: no trace
    std::uint64_t page_count = 0;
  };

  /// Where things are.
  struct Parts {
    void* model_storage = nullptr;  ///< for the ModelState
    std::byte* probe_storage = nullptr;
    std::span<FetchRequests> fetch_requests;  ///< by place
    std::span<std::byte> side_grid;
    std::span<PageTrace> traces;    ///< by place, or none
    std::span<PrefetchMark> marks;  ///< by page, or none

    /// For the ProbeState whose reader has this place.
    void* storage_of_probe(std::uint32_t index) const noexcept;
  };

  /// All of it: of the budget.
  static std::uint64_t bytes(const Needs& needs) noexcept;
  /// errors  kNoMemory.
  static Result<QueryArena> claim(const Needs& needs) noexcept;

  /// Keeps the system from paging it out; false where that is not allowed.
  bool lock() const noexcept { return memory_.lock(); }
  std::uint64_t bytes() const noexcept { return memory_.bytes(); }
  const Parts& parts() const noexcept { return parts_; }

 private:
  QueryArena(cache::PrefaultedMemory memory, const Parts& parts) noexcept
      : memory_(std::move(memory)), parts_(parts) {}

  cache::PrefaultedMemory memory_;
  Parts parts_;
};

}  // namespace planetree::query
