#include "query/serve/fetch_worker.h"

#include <algorithm>
#include <utility>

namespace planetree::query {
namespace {

// How far ahead of a moving probe to look, by how long pages take to come.
constexpr FetchWorker::Seconds kMinAhead{0.005}, kMaxAhead{0.2};
constexpr unsigned kPositionsAhead = 4;

QueryOptions waiting(std::uint64_t parts) {
  QueryOptions options;
  options.parts = static_cast<std::uint32_t>(parts);
  options.max_work = QueryOptions::kRealTimeWork;
  return options;
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

FetchWorker::FetchWorker(std::span<FetchRequests> requests, std::unique_ptr<FetchProbe> probe,
                         std::size_t first, std::size_t step, Clock clock,
                         const std::atomic<bool>& stop)
    : requests_(requests),
      probe_(std::move(probe)),
      first_(first),
      step_(step),
      clock_(clock),
      stop_(stop),
      seen_(requests.size()),
      next_(first) {}

FetchWorker::Did FetchWorker::work() noexcept {
  const auto any_of_mine = [this](bool (FetchWorker::*serve)(std::size_t) noexcept) {
    for (std::size_t left = first_; left < seen_.size(); left += step_) {
      const std::size_t index = next_;
      next_ = index + step_ < seen_.size() ? index + step_ : first_;
      if ((this->*serve)(index)) return true;
    }
    return false;
  };
  // The pages of a wish are read with those of asks in between.
  query_was_last_ = !query_was_last_ && probe_->read_for_a_query();
  if (query_was_last_) return Did::kReadForAQuery;
  if (any_of_mine(&FetchWorker::serve_request)) return Did::kServedARequest;
  query_was_last_ = probe_->read_for_a_query();
  if (query_was_last_) return Did::kReadForAQuery;
  return any_of_mine(&FetchWorker::look_ahead) ? Did::kLookedAhead : Did::kNothing;
}

bool FetchWorker::serve_request(std::size_t index) noexcept {
  FetchRequest request;
  if (!requests_[index].missed.take(seen_[index].request, request)) return false;
  QueryOptions options = waiting(request.parts);
  options.max_error = request.max_error;
  options.max_distance = request.max_distance;
  // A probe that remembers may spend its work elsewhere than one from the root.
  options.max_work = std::clamp(static_cast<std::uint32_t>(request.max_work),
                                QueryOptions::kRealTimeWork, QueryOptions::kNoLimit - 1);
  const Seconds began = clock_();
  probe_->bring_pages(request.point, options, false, stop_);
  note_time(clock_() - began);
  return true;
}

// One place at a time, so that wishes need not wait for all.
bool FetchWorker::look_ahead(std::size_t index) noexcept {
  Seen& seen = seen_[index];
  if (requests_[index].motion.take(seen.motion, seen.moving))
    seen.slots_left = is_moving(seen.moving) ? kPositionsAhead : 0;
  if (seen.slots_left == 0) return false;
  const unsigned at = kPositionsAhead - --seen.slots_left;
  const Seconds ahead = std::clamp(2 * slowest_, kMinAhead, kMaxAhead);
  probe_->bring_pages(ahead_of(seen.moving, ahead * at / kPositionsAhead),
                      waiting(seen.moving.parts), true, stop_);
  return true;
}

// The slowest wish lately: each later one counts for a sixteenth.
void FetchWorker::note_time(Seconds taken) noexcept {
  slowest_ = std::max(taken, slowest_ + (taken - slowest_) / 16);
}

}  // namespace planetree::query
