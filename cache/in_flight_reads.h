#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <span>

#include "cache/policy/frame_states.h"

namespace planetree::cache {

/// The page that a fetcher reads or waits for. One entry per fetcher, as in limbo.
struct InFlightRead {
  enum class Stage : std::uint8_t {
    kNone = 0,
    kReads,   ///< fills a frame with `page`
    kWaits,   ///< waits for `page`, which another fetcher reads
    kWanted,  ///< waits for `page`, which no fetcher reads yet
    kServed,  ///< has waited: `page` is in `frame`, which is held for this fetcher
    kFailed,  ///< has waited: `page` is unreadable
    kRetry,   ///< has waited: the other fetcher gave up, so this one must read `page` itself
    kLate,    ///< has waited: `page` cannot be read now
  };

  Stage stage;
  bool reads_itself;  ///< false: waits for a helper to read the page
  std::uint32_t page;
  std::uint32_t frame;
  std::uint64_t number;  ///< orders waiting fetchers by the time their wait began
};

/// Knows which fetcher reads which page, and which fetchers wait for it. So each page is read
/// once, however many fetchers need it, and stays resident until those that waited have taken it.
///
///     kNone --> kReads --> kNone
///     kNone --> kWaits <--> kWanted --> kNone, at the wait limit
///                 |            |
///                 |--> kServed, kFailed or kRetry --> kNone
///
/// Only the holder of the cache's mutex may call it. A view of memory that PageCache owns.
class InFlightReads {
 public:
  /// Page number that means "no page".
  static constexpr std::uint32_t kNoPage = ~std::uint32_t{0};

  /// `in_flight_reads` has one element per fetcher, all 0.
  explicit InFlightReads(std::span<InFlightRead> in_flight_reads) noexcept
      : in_flight_reads_(in_flight_reads) {}

  const InFlightRead& of(std::uint32_t fetcher) const noexcept { return in_flight_reads_[fetcher]; }

  /// Whether a fetcher is reading `page`.
  bool is_being_read(std::uint32_t page) const noexcept;
  /// Notes that `fetcher` begins to read a page that no fetcher reads.
  void read(std::uint32_t fetcher, std::uint32_t page) noexcept;
  /// Notes that `fetcher` begins to wait for a page that is not resident.
  void wait(std::uint32_t fetcher, std::uint32_t page, bool reads_itself) noexcept;
  /// Ends the fetcher's read or wait.
  void end(std::uint32_t fetcher) noexcept;

  /// Among the pages that are waited for and that no fetcher reads, returns the one whose wait
  /// began first, or "no page" if there is none.
  std::uint32_t next_wanted_page() const noexcept;

  /// Notes that the page is in `frame`. Calls wake(fetcher) for each fetcher that waited for it
  /// and returns their number.
  template <class Wake>
  std::uint32_t serve(std::uint32_t page, std::uint32_t frame, const Wake& wake) noexcept {
    return end_waits(page, InFlightRead::Stage::kServed, frame, wake);
  }
  /// Notes that the page is unreadable. Calls wake(fetcher) for each fetcher that waited for it.
  template <class Wake>
  void fail(std::uint32_t page, const Wake& wake) noexcept {
    end_waits(page, InFlightRead::Stage::kFailed, kNoFrame, wake);
  }
  /// Notes that the page cannot be read now. Calls wake(fetcher) for each fetcher that waited for
  /// it.
  template <class Wake>
  void give_up(std::uint32_t page, const Wake& wake) noexcept {
    end_waits(page, InFlightRead::Stage::kLate, kNoFrame, wake);
  }
  /// Notes that the fetcher that read the page gave up because the read would block. Calls
  /// wake(fetcher) for the waiting fetchers that read pages themselves. The others go on waiting,
  /// for a helper.
  template <class Wake>
  void abandon(std::uint32_t page, const Wake& wake) noexcept;

  /// Whether a fetcher that waited for the page in this frame has still to take it.
  bool holds(std::uint32_t frame) const noexcept;

 private:
  static bool waits_for(const InFlightRead& in_flight, std::uint32_t page) noexcept {
    return (in_flight.stage == InFlightRead::Stage::kWaits ||
            in_flight.stage == InFlightRead::Stage::kWanted) &&
           in_flight.page == page;
  }
  template <class Visit>
  void each_waiting(std::uint32_t page, const Visit& visit) noexcept;
  template <class Wake>
  std::uint32_t end_waits(std::uint32_t page, InFlightRead::Stage stage, std::uint32_t frame,
                          const Wake& wake) noexcept;

  std::span<InFlightRead> in_flight_reads_;
  std::uint32_t waiting_ = 0;  // entries in kWaits or kWanted; usually 0, which saves searching
  std::uint64_t next_number_ = 0;
};

template <class Visit>
void InFlightReads::each_waiting(std::uint32_t page, const Visit& visit) noexcept {
  for (std::uint32_t fetcher = 0; waiting_ > 0 && fetcher < in_flight_reads_.size(); ++fetcher)
    if (waits_for(in_flight_reads_[fetcher], page)) visit(fetcher, in_flight_reads_[fetcher]);
}

template <class Wake>
std::uint32_t InFlightReads::end_waits(std::uint32_t page, InFlightRead::Stage stage,
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
void InFlightReads::abandon(std::uint32_t page, const Wake& wake) noexcept {
  each_waiting(page, [&](std::uint32_t fetcher, InFlightRead& in_flight) {
    in_flight.stage =
        in_flight.reads_itself ? InFlightRead::Stage::kRetry : InFlightRead::Stage::kWanted;
    if (!in_flight.reads_itself) return;
    --waiting_;
    wake(fetcher);
  });
}

inline bool InFlightReads::is_being_read(std::uint32_t page) const noexcept {
  return std::any_of(
      in_flight_reads_.begin(), in_flight_reads_.end(), [page](const InFlightRead& in_flight) {
        return in_flight.stage == InFlightRead::Stage::kReads && in_flight.page == page;
      });
}

inline void InFlightReads::read(std::uint32_t fetcher, std::uint32_t page) noexcept {
  assert(in_flight_reads_[fetcher].stage == InFlightRead::Stage::kNone && !is_being_read(page));
  in_flight_reads_[fetcher].stage = InFlightRead::Stage::kReads;
  in_flight_reads_[fetcher].page = page;
  if (waiting_ == 0) return;
  for (InFlightRead& in_flight : in_flight_reads_)
    if (waits_for(in_flight, page)) in_flight.stage = InFlightRead::Stage::kWaits;
}

inline void InFlightReads::wait(std::uint32_t fetcher, std::uint32_t page,
                                bool reads_itself) noexcept {
  assert(in_flight_reads_[fetcher].stage == InFlightRead::Stage::kNone);
  const InFlightRead::Stage stage =
      is_being_read(page) ? InFlightRead::Stage::kWaits : InFlightRead::Stage::kWanted;
  assert(stage == InFlightRead::Stage::kWaits || !reads_itself);
  in_flight_reads_[fetcher] = {stage, reads_itself, page, kNoFrame, next_number_++};
  ++waiting_;
}

inline void InFlightReads::end(std::uint32_t fetcher) noexcept {
  InFlightRead& in_flight = in_flight_reads_[fetcher];
  if (in_flight.stage == InFlightRead::Stage::kWaits ||
      in_flight.stage == InFlightRead::Stage::kWanted)
    --waiting_;
  in_flight.stage = InFlightRead::Stage::kNone;
}

inline std::uint32_t InFlightReads::next_wanted_page() const noexcept {
  if (waiting_ == 0) return kNoPage;
  const InFlightRead* first = nullptr;
  for (const InFlightRead& in_flight : in_flight_reads_)
    if (in_flight.stage == InFlightRead::Stage::kWanted &&
        (!first || in_flight.number < first->number))
      first = &in_flight;
  return first ? first->page : kNoPage;
}

inline bool InFlightReads::holds(std::uint32_t frame) const noexcept {
  return std::any_of(
      in_flight_reads_.begin(), in_flight_reads_.end(), [frame](const InFlightRead& in_flight) {
        return in_flight.stage == InFlightRead::Stage::kServed && in_flight.frame == frame;
      });
}

}  // namespace planetree::cache
