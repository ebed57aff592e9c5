#include "cache/in_flight_reads.h"

#include <algorithm>
#include <cassert>

namespace planetree::cache {

using Stage = Errand::Stage;

bool Errands::is_read(std::uint32_t page) const noexcept {
  return std::any_of(errands_.begin(), errands_.end(), [page](const Errand& errand) {
    return errand.stage == Stage::kReads && errand.page == page;
  });
}

void Errands::read(std::uint32_t owner, std::uint32_t page) noexcept {
  assert(errands_[owner].stage == Stage::kNone && !is_read(page));
  errands_[owner].stage = Stage::kReads;
  errands_[owner].page = page;
  if (waiting_ == 0) return;
  for (Errand& errand : errands_)
    if (waits_for(errand, page)) errand.stage = Stage::kWaits;
}

void Errands::wait(std::uint32_t owner, std::uint32_t page, bool reads_itself) noexcept {
  assert(errands_[owner].stage == Stage::kNone);
  const Stage stage = is_read(page) ? Stage::kWaits : Stage::kWanted;
  assert(stage == Stage::kWaits || !reads_itself);
  errands_[owner] = {stage, reads_itself, page, kNoFrame, next_number_++};
  ++waiting_;
}

void Errands::end(std::uint32_t owner) noexcept {
  Errand& errand = errands_[owner];
  if (errand.stage == Stage::kWaits || errand.stage == Stage::kWanted) --waiting_;
  errand.stage = Stage::kNone;
}

std::uint32_t Errands::page_wanted() const noexcept {
  if (waiting_ == 0) return kNobody;
  const Errand* first = nullptr;
  for (const Errand& errand : errands_)
    if (errand.stage == Stage::kWanted && (!first || errand.number < first->number))
      first = &errand;
  return first ? first->page : kNobody;
}

bool Errands::holds(std::uint32_t frame) const noexcept {
  return std::any_of(errands_.begin(), errands_.end(), [frame](const Errand& errand) {
    return errand.stage == Stage::kServed && errand.frame == frame;
  });
}

}  // namespace planetree::cache
