#include "query/serve/page_trace.h"

#include <bit>

namespace planetree::query {

bool PageTrace::find_room() noexcept {
  if (!is_dropping_ && ring_.find_room(1)) return true;
  ring_.drop();
  is_dropping_ = true;
  time_ = kNoTime;
  return false;
}

void PageTrace::begin_time(std::uint64_t time, std::uint64_t number) noexcept {
  // One more word, so that the new time is not the last word that finds room.
  constexpr std::uint64_t kWords = 3;
  is_dropping_ = !ring_.has_room(kWords) && !ring_.find_room(kWords);
  time_ = is_dropping_ ? kNoTime : time;
  if (is_dropping_) return ring_.forget_room();
  ring_.stage(TraceWord::of(TraceEvent::kTime, time & TraceWord::kMaxValue));
  ring_.stage(TraceWord::of(TraceEvent::kNumber, number & TraceWord::kMaxValue));
}

void PageTrace::skipped(float bound) noexcept {
  const std::uint64_t place = ring_.staged();
  if (is_dropping_ || place == ring_.published()) return;
  if (TraceWord{ring_.staged(place - 1)}.event() != TraceEvent::kMissed) return;
  if (ring_.has_room(1) || ring_.find_room(1))
    ring_.stage(TraceWord::of(TraceEvent::kBound, std::bit_cast<std::uint32_t>(bound)));
}

template <class IsNeeded>
void PageTrace::mark_needed(const IsNeeded& is_needed) noexcept {
  for (std::uint64_t place = ring_.published(); place < ring_.staged(); ++place) {
    const TraceWord word{ring_.staged(place)};
    if (word.event() != TraceEvent::kMissed) continue;
    const bool is_last = place + 1 == ring_.staged();
    const TraceWord next{is_last ? 0 : ring_.staged(place + 1)};
    const bool has_bound = !is_last && next.event() == TraceEvent::kBound;
    if (is_needed(has_bound, next.real())) ring_.restage(place, word.bits | TraceWord::kFlag);
  }
}

void PageTrace::need_within(float threshold) noexcept {
  mark_needed([threshold](bool has_bound, float bound) { return has_bound && bound <= threshold; });
}

void PageTrace::need_others() noexcept {
  mark_needed([](bool has_bound, float) { return !has_bound; });
}

void PageTrace::degraded(double width) noexcept {
  note(TraceEvent::kDegraded, std::bit_cast<std::uint32_t>(static_cast<float>(width)));
  ring_.publish();
}

void PageTrace::fetched(std::uint32_t page) noexcept {
  clock_->advance();
  if (clock_->now() != time_) begin_time(clock_->now(), last_number());
  note(TraceEvent::kFetched, TraceWord::kFlag | page);
  ring_.publish();
}

void PageTrace::motion(const Vec3& position, const Vec3& velocity) noexcept {
  if (clock_->now() != time_) begin_time(clock_->now(), queries_);
  if (is_dropping_ ||
      !(ring_.has_room(TraceWord::kMotionWords) || ring_.find_room(TraceWord::kMotionWords)))
    return ring_.drop();
  const std::uint64_t prefix =
      TraceWord::prefix(PageAccess::Query::kClosestPoint, false, false, queries_);
  ring_.stage(TraceWord::of(TraceEvent::kMotion, prefix));
  for (const double value :
       {position.x, position.y, position.z, velocity.x, velocity.y, velocity.z})
    ring_.stage(std::bit_cast<std::uint64_t>(value));
  ring_.publish();
}

void PageTrace::note_in_cache(TraceEvent event, std::uint64_t rest) noexcept {
  begin_time(clock_->tick(), last_number());
  note(event, rest);
  ring_.publish();
}

void PageTrace::installed(std::uint32_t page, bool is_upper) noexcept {
  note_in_cache(TraceEvent::kInstalled, (is_upper ? TraceWord::kFlag : 0) | page);
}

void PageTrace::evicted(std::uint32_t page) noexcept { note_in_cache(TraceEvent::kEvicted, page); }

PageAccess::Query PageTrace::set_kind(PageAccess::Query kind) noexcept {
  const PageAccess::Query last = TraceWord{prefix_}.query();
  prefix_ = TraceWord::prefix(kind, true, false, last_number());
  return last;
}

void PageTraces::finish_open() noexcept {
  has_open = dropped() == 0;
  if (has_open) return;
  for (PageTrace& trace : of_readers) trace.clear();
}

std::uint64_t PageTraces::dropped() const noexcept {
  std::uint64_t dropped = 0;
  for (PageTrace& trace : of_readers) dropped += trace.ring().dropped();
  return dropped;
}

}  // namespace planetree::query
