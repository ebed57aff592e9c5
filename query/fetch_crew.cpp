#include "query/fetch_crew.h"

#include <algorithm>
#include <chrono>
#include <new>
#include <system_error>
#include <utility>

#include "query/closest_point.h"
#include "query/host_arithmetic.h"

namespace planetree::query {
namespace {

using Clock = std::chrono::steady_clock;

constexpr auto kPause = std::chrono::microseconds(150);
constexpr auto kLongPause = std::chrono::milliseconds(10);
constexpr auto kLately = std::chrono::seconds(1);

// How far ahead of a moving probe to look, by how long pages take to come.
constexpr double kLeastAheadS = 0.005, kMostAheadS = 0.2;
constexpr unsigned kPlacesAhead = 4;

Ask waiting(std::uint64_t parts) {
  Ask ask;
  ask.parts = static_cast<std::uint32_t>(parts);
  // What takes more cannot be answered in real time, however much is resident.
  ask.max_nodes = Ask::kRealTimeNodes;
  return ask;
}

bool is_moving(const Motion& motion) {
  return motion.velocity.x != 0 || motion.velocity.y != 0 || motion.velocity.z != 0;
}

Vec3 ahead_of(const Motion& motion, double seconds) {
  return {motion.position.x + motion.velocity.x * seconds,
          motion.position.y + motion.velocity.y * seconds,
          motion.position.z + motion.velocity.z * seconds};
}

}  // namespace

/// What one thread does: it serves every so-many-th probe.
class FetchCrew::Worker {
 public:
  Worker(FetchCrew& crew, cache::Reader reader, unsigned first, unsigned step)
      : crew_(crew),
        probe_(crew.model_, std::move(reader)),
        first_(first),
        step_(step),
        seen_(crew.model_.reader_count()) {}

  void run() noexcept {
    const HostArithmetic host;
    Clock::time_point last = Clock::now() - kLately;
    while (!crew_.stopping_.load(std::memory_order_relaxed)) {
      // Wishes come before plans, each time.
      const bool any = serve_wishes() || look_ahead();
      if (any)
        last = Clock::now();
      else
        crew_.sleep(Clock::now() - last < kLately);
    }
  }

 private:
  struct Seen {
    std::uint64_t wish = 0, motion = 0;
    Motion moving;
    unsigned places_left = 0;  // of those to look at ahead of the last motion
  };

  bool serve_wishes() noexcept {
    bool any = false;
    for (std::size_t place = first_; place < seen_.size(); place += step_) {
      Wish wish;
      if (!wishes(place).missed.take(seen_[place].wish, wish)) continue;
      Ask ask = waiting(wish.parts);
      ask.max_error = wish.max_error;
      ask.max_distance = wish.max_distance;
      const Clock::time_point began = Clock::now();
      bring_pages(probe_, wish.point, ask);
      note_seconds(std::chrono::duration<double>(Clock::now() - began).count());
      crew_.wishes_fetched_.fetch_add(1, std::memory_order_relaxed);
      any = true;
    }
    return any;
  }

  // One place at a time, so that wishes need not wait for all.
  bool look_ahead() noexcept {
    for (std::size_t place = first_; place < seen_.size(); place += step_) {
      Seen& seen = seen_[place];
      if (wishes(place).motion.take(seen.motion, seen.moving))
        seen.places_left = is_moving(seen.moving) ? kPlacesAhead : 0;
      if (seen.places_left == 0) continue;
      const unsigned at = kPlacesAhead - --seen.places_left;
      const double ahead_s = std::clamp(2 * slowest_s_, kLeastAheadS, kMostAheadS);
      bring_pages(probe_, ahead_of(seen.moving, ahead_s * at / kPlacesAhead),
                  waiting(seen.moving.parts));
      crew_.places_prefetched_.fetch_add(1, std::memory_order_relaxed);
      return true;
    }
    return false;
  }

  // The slowest wish lately: each later one counts for a sixteenth.
  void note_seconds(double seconds) noexcept {
    slowest_s_ = std::max(seconds, slowest_s_ + (seconds - slowest_s_) / 16);
  }

  Wishes& wishes(std::size_t place) const noexcept {
    return crew_.model_.wishes(static_cast<std::uint32_t>(place));
  }

  FetchCrew& crew_;
  ProbeState probe_;
  const unsigned first_, step_;
  std::vector<Seen> seen_;
  double slowest_s_ = 0;
};

Result<std::unique_ptr<FetchCrew>> FetchCrew::start(const ModelState& model, unsigned threads) {
  const auto refused = [&] {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "the system refused %u fetch threads; free memory or ask for fewer", threads);
  };
  try {
    std::unique_ptr<FetchCrew> crew(new FetchCrew(model));
    for (unsigned i = 0; i < threads; ++i) {
      auto reader = model.claim_reader();
      if (!reader) return reader.error();
      crew->workers_.push_back(std::make_unique<Worker>(*crew, *std::move(reader), i, threads));
    }
    for (const auto& worker : crew->workers_)
      crew->threads_.emplace_back([&worker = *worker] { worker.run(); });
    return crew;
  } catch (const std::bad_alloc&) {
    return refused();
  } catch (const std::system_error&) {
    return refused();
  }
}

FetchCrew::FetchCrew(const ModelState& model) : model_(model) {}

FetchCrew::~FetchCrew() {
  {
    const std::lock_guard lock(mutex_);
    stopping_.store(true, std::memory_order_relaxed);
  }
  stopped_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

void FetchCrew::sleep(bool lately) {
  std::unique_lock lock(mutex_);
  const auto stopping = [this] { return stopping_.load(std::memory_order_relaxed); };
  if (lately)
    stopped_.wait_for(lock, kPause, stopping);
  else
    stopped_.wait_for(lock, kLongPause, stopping);
}

}  // namespace planetree::query
