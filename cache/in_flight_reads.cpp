#include "cache/in_flight_reads.h"

#include <algorithm>
#include <cassert>

namespace planetree::cache {

using Stage = InFlightRead::Stage;

bool InFlightReads::is_being_read(std::uint32_t page) const noexcept {
  return std::any_of(in_flight_reads_.begin(), in_flight_reads_.end(),
                     [page](const InFlightRead& in_flight) {
                       return in_flight.stage == Stage::kReads && in_flight.page == page;
                     });
}

void InFlightReads::read(std::uint32_t fetcher, std::uint32_t page) noexcept {
  assert(in_flight_reads_[fetcher].stage == Stage::kNone && !is_being_read(page));
  in_flight_reads_[fetcher].stage = Stage::kReads;
  in_flight_reads_[fetcher].page = page;
  if (waiting_ == 0) return;
  for (InFlightRead& in_flight : in_flight_reads_)
    if (waits_for(in_flight, page)) in_flight.stage = Stage::kWaits;
}

void InFlightReads::wait(std::uint32_t fetcher, std::uint32_t page, bool reads_itself) noexcept {
  assert(in_flight_reads_[fetcher].stage == Stage::kNone);
  const Stage stage = is_being_read(page) ? Stage::kWaits : Stage::kWanted;
  assert(stage == Stage::kWaits || !reads_itself);
  in_flight_reads_[fetcher] = {stage, reads_itself, page, kNoFrame, next_number_++};
  ++waiting_;
}

void InFlightReads::end(std::uint32_t fetcher) noexcept {
  InFlightRead& in_flight = in_flight_reads_[fetcher];
  if (in_flight.stage == Stage::kWaits || in_flight.stage == Stage::kWanted) --waiting_;
  in_flight.stage = Stage::kNone;
}

std::uint32_t InFlightReads::next_wanted_page() const noexcept {
  if (waiting_ == 0) return kNoPage;
  const InFlightRead* first = nullptr;
  for (const InFlightRead& in_flight : in_flight_reads_)
    if (in_flight.stage == Stage::kWanted && (!first || in_flight.number < first->number))
      first = &in_flight;
  return first ? first->page : kNoPage;
}

bool InFlightReads::holds(std::uint32_t frame) const noexcept {
  return std::any_of(in_flight_reads_.begin(), in_flight_reads_.end(),
                     [frame](const InFlightRead& in_flight) {
                       return in_flight.stage == Stage::kServed && in_flight.frame == frame;
                     });
}

}  // namespace planetree::cache
