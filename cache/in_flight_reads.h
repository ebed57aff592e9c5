#pragma once

#include <cstdint>
#include <span>

#include "cache/frame_pool.h"

namespace planetree::cache {

/// What a thread that may fetch is about; it has one place for that, as in limbo.
struct InFlightRead {
  enum class Stage : std::uint8_t {
    kNone = 0,
    kReads,   ///< fills a frame with `page`
    kWaits,   ///< for `page`, which another reads
    kWanted,  ///< waits for `page`, which nobody reads yet
    kServed,  ///< waited: `page` is in `frame`, held until it is taken
    kFailed,  ///< waited: `page` is unreadable
    kRetry,   ///< waited for one who did not read it, and is to do so itself
  };

  Stage stage;
  bool reads_itself;  ///< rather than wait for a helper
  std::uint32_t page;
  std::uint32_t frame;
  std::uint64_t number;  ///< errands that wait, in the order in which they began
};

/// Who reads which page, and who waits for it: so that each page is read once, however many
/// want it, and that it is still there when they come for it.
///
///     kNone --> kReads --> kNone
///     kNone --> kWaits <--> kWanted --> kNone, at a limit
///                 |            |
///                 |--> kServed, kFailed or kRetry --> kNone
///
/// For the holder of the cache's mutex alone. A view of memory that PageCache owns.
class InFlightReads {
 public:
  static constexpr std::uint32_t kNobody = ~std::uint32_t{0};

  /// `errands` has one element per owner, all 0.
  explicit InFlightReads(std::span<InFlightRead> in_flight_reads) noexcept
      : in_flight_reads_(in_flight_reads) {}

  const InFlightRead& of(std::uint32_t fetcher) const noexcept { return in_flight_reads_[fetcher]; }

  bool is_read(std::uint32_t page) const noexcept;
  /// The owner begins to read a page that nobody reads.
  void read(std::uint32_t fetcher, std::uint32_t page) noexcept;
  /// The owner begins to wait for a page that is not resident.
  void wait(std::uint32_t fetcher, std::uint32_t page, bool reads_itself) noexcept;
  /// Whatever the owner was about, it is over.
  void end(std::uint32_t fetcher) noexcept;

  /// The page that was waited for longest of those that nobody reads; kNobody if there is none.
  std::uint32_t page_wanted() const noexcept;

  /// The page is in `frame` now. Calls wake(owner) for all that waited; how many those were.
  template <class Wake>
  std::uint32_t serve(std::uint32_t page, std::uint32_t frame, const Wake& wake) noexcept {
    return tell_all(page, InFlightRead::Stage::kServed, frame, wake);
  }
  /// The page is unreadable.
  template <class Wake>
  void fail(std::uint32_t page, const Wake& wake) noexcept {
    tell_all(page, InFlightRead::Stage::kFailed, kNoFrame, wake);
  }
  /// Whoever read it gave up, because it would have had to wait. Of those that waited, the ones
  /// that read pages themselves are woken; the others need a helper.
  template <class Wake>
  void put_back(std::uint32_t page, const Wake& wake) noexcept;

  /// Whether somebody who was served has not yet come for what is in this frame.
  bool holds(std::uint32_t frame) const noexcept;

 private:
  static bool waits_for(const InFlightRead& in_flight, std::uint32_t page) noexcept {
    return (in_flight.stage == InFlightRead::Stage::kWaits ||
            in_flight.stage == InFlightRead::Stage::kWanted) &&
           in_flight.page == page;
  }
  template <class Tell>
  void each_waiting(std::uint32_t page, const Tell& tell) noexcept;
  template <class Wake>
  std::uint32_t tell_all(std::uint32_t page, InFlightRead::Stage stage, std::uint32_t frame,
                         const Wake& wake) noexcept;

  std::span<InFlightRead> in_flight_reads_;
  std::uint32_t waiting_ = 0;  // kWaits or kWanted: mostly none, and then nothing is searched
  std::uint64_t next_number_ = 0;
};

template <class Tell>
void InFlightReads::each_waiting(std::uint32_t page, const Tell& tell) noexcept {
  for (std::uint32_t fetcher = 0; waiting_ > 0 && fetcher < in_flight_reads_.size(); ++fetcher)
    if (waits_for(in_flight_reads_[fetcher], page)) tell(fetcher, in_flight_reads_[fetcher]);
}

template <class Wake>
std::uint32_t InFlightReads::tell_all(std::uint32_t page, InFlightRead::Stage stage,
                                      std::uint32_t frame, const Wake& wake) noexcept {
  std::uint32_t woken = 0;
  each_waiting(page, [&](std::uint32_t fetcher, InFlightRead& in_flight) {
    in_flight.stage = stage;
    in_flight.frame = frame;
    --waiting_;
    ++woken;
    wake(fetcher);
  });
  return woken;
}

template <class Wake>
void InFlightReads::put_back(std::uint32_t page, const Wake& wake) noexcept {
  each_waiting(page, [&](std::uint32_t fetcher, InFlightRead& in_flight) {
    in_flight.stage =
        in_flight.reads_itself ? InFlightRead::Stage::kRetry : InFlightRead::Stage::kWanted;
    if (!in_flight.reads_itself) return;
    --waiting_;
    wake(fetcher);
  });
}

}  // namespace planetree::cache
