#include "query/serve/fetch_worker.h"

#include <algorithm>
#include <utility>

#include "query/answer/closest_point.h"

namespace planetree::query {
namespace {

// How far ahead of a moving probe to look, by how long pages take to come.
constexpr FetchWorker::Seconds kLeastAhead{0.005}, kMostAhead{0.2};
constexpr unsigned kPlacesAhead = 4;

Ask waiting(std::uint64_t parts) {
  Ask ask;
  ask.parts = static_cast<std::uint32_t>(parts);
  ask.max_nodes = Ask::kRealTimeNodes;
  return ask;
}

bool is_moving(const Motion& motion) {
  return motion.velocity.x != 0 || motion.velocity.y != 0 || motion.velocity.z != 0;
}

Vec3 ahead_of(const Motion& motion, FetchWorker::Seconds time) {
  return {motion.position.x + motion.velocity.x * time.count(),
          motion.position.y + motion.velocity.y * time.count(),
          motion.position.z + motion.velocity.z * time.count()};
}

}  // namespace

FetchWorker::FetchWorker(const ModelState& model, cache::Reader reader, std::size_t first,
                         std::size_t step, Clock clock, const std::atomic<bool>& stop)
    : model_(model),
      probe_(model, std::move(reader)),
      first_(first),
      step_(step),
      clock_(clock),
      stop_(stop),
      seen_(model.reader_count()),
      next_(first) {}

FetchWorker::Did FetchWorker::work() noexcept {
  const auto any_of_mine = [this](bool (FetchWorker::*serve)(std::size_t) noexcept) {
    for (std::size_t left = first_; left < seen_.size(); left += step_) {
      const std::size_t place = next_;
      next_ = place + step_ < seen_.size() ? place + step_ : first_;
      if ((this->*serve)(place)) return true;
    }
    return false;
  };
  // The pages of a wish are read with those of asks in between.
  ask_was_last_ = !ask_was_last_ && read_for_an_ask();
  if (ask_was_last_) return Did::kReadForAnAsk;
  if (any_of_mine(&FetchWorker::serve_wish)) return Did::kServedAWish;
  ask_was_last_ = read_for_an_ask();
  if (ask_was_last_) return Did::kReadForAnAsk;
  return any_of_mine(&FetchWorker::look_ahead) ? Did::kLookedAhead : Did::kNothing;
}

bool FetchWorker::serve_wish(std::size_t place) noexcept {
  Wish wish;
  if (!wishes(place).missed.take(seen_[place].wish, wish)) return false;
  Ask ask = waiting(wish.parts);
  ask.max_error = wish.max_error;
  ask.max_distance = wish.max_distance;
  // A probe that remembers may spend its work elsewhere than one from the root.
  ask.max_nodes = std::clamp(static_cast<std::uint32_t>(wish.max_nodes), Ask::kRealTimeNodes,
                             Ask::kNoLimit - 1);
  const Seconds began = clock_();
  bring_pages(probe_, wish.point, ask, stop_);
  note_time(clock_() - began);
  return true;
}

// One place at a time, so that wishes need not wait for all.
bool FetchWorker::look_ahead(std::size_t place) noexcept {
  Seen& seen = seen_[place];
  if (wishes(place).motion.take(seen.motion, seen.moving))
    seen.places_left = is_moving(seen.moving) ? kPlacesAhead : 0;
  if (seen.places_left == 0) return false;
  const unsigned at = kPlacesAhead - --seen.places_left;
  const Seconds ahead = std::clamp(2 * slowest_, kLeastAhead, kMostAhead);
  probe_.touches().set_looks_ahead(true);
  bring_pages(probe_, ahead_of(seen.moving, ahead * at / kPlacesAhead), waiting(seen.moving.parts),
              stop_);
  probe_.touches().set_looks_ahead(false);
  return true;
}

// The slowest wish lately: each later one counts for a sixteenth.
void FetchWorker::note_time(Seconds taken) noexcept {
  slowest_ = std::max(taken, slowest_ + (taken - slowest_) / 16);
}

}  // namespace planetree::query
