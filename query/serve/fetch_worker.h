#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "query/model_state.h"
#include "query/probe_state.h"

namespace planetree::query {

/// Gets for a model's probes what they miss (Wait::kNever) and what they are moving to: it asks
/// the same question again with a probe that waits for pages, from the root down. Serves every
/// so-many-th probe. And reads, for whoever waits, the pages that the disk must be waited for.
/// One thread.
class FetchWorker {
 public:
  using Seconds = std::chrono::duration<double>;
  using Clock = Seconds (*)();

  /// Of each probe served.
  static constexpr std::uint64_t kProbeBytes = 96;

  /// first, step  serves the probes whose readers have the places first, first + step, ...
  /// clock        tells how long pages take to come, and so how far ahead to look.
  /// stop         ends work() early, once true; must outlive this.
  FetchWorker(const ModelState& model, cache::Reader reader, std::size_t first, std::size_t step,
              Clock clock, const std::atomic<bool>& stop);

  enum class Did : std::uint8_t { kNothing, kServedARequest, kLookedAhead, kReadForAQuery };
  /// Does one thing that there is to do: reads a page that an ask waits for, and wishes, come
  /// before plans, and of these two neither comes twice while the other waits.
  Did work() noexcept;

 private:
  struct Seen {
    std::uint64_t request = 0, motion = 0;
    Motion moving;
    unsigned slots_left = 0;  // of those to look at ahead of the last motion
  };
  static_assert(sizeof(Seen) <= kProbeBytes);

  bool read_for_a_query() noexcept { return probe_.reader().help(); }
  bool serve_request(std::size_t index) noexcept;
  bool look_ahead(std::size_t index) noexcept;
  void note_time(Seconds taken) noexcept;
  FetchRequests& fetch_requests(std::size_t index) const noexcept {
    return model_.fetch_requests(static_cast<std::uint32_t>(index));
  }

  const ModelState& model_;
  ProbeState probe_;
  const std::size_t first_, step_;
  const Clock clock_;
  const std::atomic<bool>& stop_;
  std::vector<Seen> seen_;  // by place
  std::size_t next_ = 0;    // the place served next: none is kept waiting by another
  bool query_was_last_ = false;
  Seconds slowest_{0};
};

}  // namespace planetree::query
