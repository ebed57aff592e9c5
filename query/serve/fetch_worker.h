#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "planetree/types.h"
#include "query/serve/fetch_requests.h"

namespace planetree::query {

/// The probe of a fetch thread.
class FetchProbe {
 public:
  virtual ~FetchProbe() = default;

  /// Makes the pages resident that a query needs.
  ///
  /// options   Wait::kForPages, and a limit of work: the query then starts from the root, since
  ///           what a probe keeps says nothing of what is resident.
  /// is_prefetch  whether a probe is moving there, rather than missing the pages.
  /// stop      once true, gives up before the next missing page.
  virtual void fetch_pages(const Vec3& query, const QueryOptions& options, bool is_prefetch,
                           const std::atomic<bool>& stop) noexcept = 0;
  /// Reads one page that a blocking query waits for. False: there is none.
  virtual bool read_awaited_page() noexcept = 0;
};

/// Fetches what a model's probes miss (Wait::kNever) and what they are moving to: it runs the
/// same query again with a probe that waits for pages. It serves every `step`-th reader. It also
/// reads the pages that blocking queries wait for. One thread.
class FetchWorker {
 public:
  using Seconds = std::chrono::duration<double>;
  using Clock = Seconds (*)();

  /// Of each probe served.
  static constexpr std::uint64_t kProbeBytes = 96;

  /// first, step  serves the probes whose readers have the places first, first + step, ...
  /// clock        tells how long pages take to come, and so how far ahead to look.
  /// stop         ends work() early, once true; must outlive this.
  FetchWorker(std::span<FetchRequests> requests, std::unique_ptr<FetchProbe> probe,
              std::size_t first, std::size_t step, Clock clock, const std::atomic<bool>& stop);

  enum class Action : std::uint8_t { kNone, kServedRequest, kPrefetchedPosition, kReadAwaitedPage };
  /// Does one thing that there is to do: reads a page that an ask waits for, and wishes, come
  /// before plans, and of these two neither comes twice while the other waits.
  Action work() noexcept;

 private:
  struct Progress {
    std::uint64_t seen_request = 0, seen_motion = 0;
    Motion motion;
    unsigned positions_left = 0;  // of those to look at ahead of the last motion
  };
  static_assert(sizeof(Progress) <= kProbeBytes);

  bool serve_request(std::size_t index) noexcept;
  bool prefetch_position(std::size_t index) noexcept;
  void note_fetch_time(Seconds taken) noexcept;

  const std::span<FetchRequests> requests_;
  std::unique_ptr<FetchProbe> probe_;
  const std::size_t first_, step_;
  const Clock clock_;
  const std::atomic<bool>& stop_;
  std::vector<Progress> progress_;  // by place
  std::size_t next_index_ = 0;      // the place served next: none is kept waiting by another
  bool awaited_page_was_last_ = false;
  Seconds slowest_fetch_{0};
};

}  // namespace planetree::query
