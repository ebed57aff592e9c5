#include "query/serve/fetch_threads.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <new>
#include <system_error>
#include <utility>

#include "octree/geometry/fp_environment.h"

namespace planetree::query {
namespace {

using Positions = std::array<Vec3, MotionPrefetch::kPositions>;

QueryOptions blocking_options(std::uint64_t parts, std::uint64_t side_rule) {
  QueryOptions options;
  options.parts = static_cast<std::uint32_t>(parts);
  options.side_rule = static_cast<SideRule>(side_rule);
  options.max_work = QueryOptions::kRealTimeWork;
  return options;
}

}  // namespace

FetchWorker::FetchWorker(std::span<FetchRequests> requests, std::unique_ptr<FetchProbe> probe,
                         std::size_t first, std::size_t step, Clock clock,
                         const std::atomic<bool>& stop, ReadAhead* read_ahead)
    : requests_(requests),
      probe_(std::move(probe)),
      first_(first),
      step_(step),
      clock_(clock),
      stop_(stop),
      read_ahead_(read_ahead),
      progress_(requests.size()),
      next_index_(first) {}

FetchWorker::Action FetchWorker::work() noexcept {
  for (const auto step : {&FetchWorker::serve, &FetchWorker::prefetch, &FetchWorker::read_ahead})
    if (const Action action = (this->*step)(); action != Action::kNone) return action;
  return Action::kNone;
}

bool FetchWorker::serve_any_probe(bool (FetchWorker::*step)(std::size_t) noexcept) noexcept {
  for (std::size_t left = first_; left < progress_.size(); left += step_) {
    const std::size_t index = next_index_;
    next_index_ = index + step_ < progress_.size() ? index + step_ : first_;
    if ((this->*step)(index)) return true;
  }
  return false;
}

FetchWorker::Action FetchWorker::serve() noexcept {
  // While a request is served, pages that blocking queries wait for are read in between. So the two
  // alternate.
  awaited_page_was_last_ = !awaited_page_was_last_ && probe_->read_awaited_page();
  if (awaited_page_was_last_) return Action::kReadAwaitedPage;
  if (serve_any_probe(&FetchWorker::serve_request)) return Action::kServedRequest;
  awaited_page_was_last_ = probe_->read_awaited_page();
  return awaited_page_was_last_ ? Action::kReadAwaitedPage : Action::kNone;
}

FetchWorker::Action FetchWorker::prefetch() noexcept {
  return serve_any_probe(&FetchWorker::prefetch_position) ? Action::kPrefetchedPosition
                                                          : Action::kNone;
}

FetchWorker::Action FetchWorker::read_ahead() noexcept {
  return read_next_page() ? Action::kReadAhead : Action::kNone;
}

bool FetchWorker::serve_request(std::size_t index) noexcept {
  FetchRequest request;
  if (!requests_[index].missed.load_newer(progress_[index].seen_request, request)) return false;
  QueryOptions options = blocking_options(request.parts, request.side_rule);
  options.normal_rule = static_cast<NormalRule>(request.normal_rule);
  options.max_error = request.max_error;
  options.max_distance = request.max_distance;
  // A query that starts from coherence may spend its work elsewhere than this one from the root.
  options.max_work = std::clamp(static_cast<std::uint32_t>(request.max_work),
                                QueryOptions::kRealTimeWork, QueryOptions::kNoLimit - 1);
  take_motion(index);
  Positions positions;
  const Seconds began = clock_();
  if (request.is_way != 0)
    probe_->fetch_way({request.point, request.to, request.radius}, request.triangles, options,
                      stop_);
  else if (request.triangles > 0)
    probe_->fetch_triangles(request.point, request.radius, request.triangles, options, stop_);
  else
    probe_->fetch_pages(request.point, options, FetchReason::kMissed,
                        progress_[index].motion.left(slowest_fetch_, positions), stop_);
  note_fetch_time(clock_() - began);
  return true;
}

void FetchWorker::take_motion(std::size_t index) noexcept {
  Progress& progress = progress_[index];
  Motion motion;
  if (requests_[index].motion.load_newer(progress.seen_motion, motion))
    progress.motion.take(motion, clock_());
}

// Prefetches one position at a time, so that requests need not wait for all of them. A remote model
// gets the pages of the others by the same requests.
bool FetchWorker::prefetch_position(std::size_t index) noexcept {
  take_motion(index);
  MotionPrefetch& motion = progress_[index].motion;
  if (!motion.has_next()) return false;
  const MotionPrefetch::Ahead ahead = motion.next(slowest_fetch_);
  Positions positions;
  const std::uint32_t pages =
      probe_->fetch_pages(ahead.position, blocking_options(ahead.parts, ahead.side_rule),
                          ahead.searches_side ? FetchReason::kMotionOfSides : FetchReason::kMotion,
                          motion.left(slowest_fetch_, positions), stop_);
  pages_prefetched_.fetch_add(pages, std::memory_order_relaxed);
  return true;
}

// Takes a few pages, since some are resident already. Requests need not wait for more than one
// read.
bool FetchWorker::read_next_page() noexcept {
  constexpr unsigned kPages = 64;
  if (!read_ahead_) return false;
  for (unsigned left = kPages; left > 0; --left) {
    const std::uint32_t page = read_ahead_->take();
    if (page == ReadAhead::kNoPage) return false;
    if (probe_->fetch_page(page, stop_)) {
      pages_read_ahead_.fetch_add(1, std::memory_order_relaxed);
      return true;
    }
  }
  return true;
}

// Updates the maximum time of recent requests. It decays towards the time of each later request by
// a sixteenth of the difference.
void FetchWorker::note_fetch_time(Seconds taken) noexcept {
  slowest_fetch_ = std::max(taken, slowest_fetch_ + (taken - slowest_fetch_) / 16);
}

namespace {

using Clock = std::chrono::steady_clock;

// Time between two looks for requests: shorter if the last action was within kBusyPeriod.
constexpr std::chrono::microseconds kBusyPause(150), kIdlePause(10'000);
constexpr auto kBusyPeriod = std::chrono::seconds(1);

FetchWorker::Seconds time_now() { return Clock::now().time_since_epoch(); }

// A thread inherits the priority and signal mask of the thread that opened the model, which may be
// a real-time thread.
void drop_priority_and_block_signals() noexcept {
  const sched_param parameters{};
  ::pthread_setschedparam(::pthread_self(), SCHED_OTHER, &parameters);
  sigset_t all;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, nullptr);
}

// Touches as much of the stack as is ever used, so that memory does not grow later.
[[gnu::noinline]] void prefault_stack() noexcept {
  constexpr std::size_t kLineBytes = 64;
  volatile std::byte stack[FetchThreads::kThreadBytes / 4 * 3];
  for (std::size_t at = 0; at < sizeof stack; at += kLineBytes) stack[at] = std::byte{};
}

}  // namespace

std::chrono::microseconds FetchThreads::pause_after(
    std::chrono::nanoseconds since_action) noexcept {
  return since_action < kBusyPeriod ? kBusyPause : kIdlePause;
}

// The first model, in turns, that has something to do, with what is most urgent for any.
FetchWorker::Action FetchThreads::work(Lane& lane) noexcept {
  const std::lock_guard lock(lane.mutex);
  const std::size_t count = lane.served.size();
  for (const auto step : {&FetchWorker::serve, &FetchWorker::prefetch, &FetchWorker::read_ahead}) {
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = (lane.first + i) % count;
      FetchWorker& worker = *lane.served[at].worker;
      const std::uint64_t prefetched = worker.pages_prefetched(), ahead = worker.pages_read_ahead();
      const FetchWorker::Action action = (worker.*step)();
      if (action == FetchWorker::Action::kNone) continue;
      lane.first = at + 1;
      pages_prefetched_.fetch_add(worker.pages_prefetched() - prefetched,
                                  std::memory_order_relaxed);
      pages_read_ahead_.fetch_add(worker.pages_read_ahead() - ahead, std::memory_order_relaxed);
      return action;
    }
  }
  return FetchWorker::Action::kNone;
}

void FetchThreads::run(Lane& lane) noexcept {
  prefault_stack();
  drop_priority_and_block_signals();
  const octree::FpEnvironmentGuard host;
  Clock::time_point last = Clock::now() - kBusyPeriod;
  while (!stopping_.load(std::memory_order_relaxed)) {
    const FetchWorker::Action action = work(lane);
    if (action == FetchWorker::Action::kReadAwaitedPage) continue;
    if (action == FetchWorker::Action::kNone) {
      cache_.wait_for_wanted_page(pause_after(Clock::now() - last), stopping_);
      continue;
    }
    last = Clock::now();
    if (action == FetchWorker::Action::kServedRequest)
      requests_served_.fetch_add(1, std::memory_order_relaxed);
  }
}

Result<std::unique_ptr<FetchThreads>> FetchThreads::start(cache::PageCache& cache,
                                                          std::size_t count) {
  const auto refused = [count] {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "the system refused %zu fetch threads; free memory or lower fetch_threads",
                      count);
  };
  try {
    std::unique_ptr<FetchThreads> threads(new FetchThreads(cache));
    for (std::size_t i = 0; i < count; ++i) threads->lanes_.push_back(std::make_unique<Lane>());
    for (const auto& lane : threads->lanes_)
      lane->thread = std::thread([&threads = *threads, &lane = *lane] { threads.run(lane); });
    return threads;
  } catch (const std::bad_alloc&) {
    return refused();
  } catch (const std::system_error&) {
    return refused();
  }
}

Result<void> FetchThreads::add(std::span<FetchRequests> requests,
                               std::vector<std::unique_ptr<FetchProbe>> probes,
                               ReadAhead* read_ahead) {
  assert(probes.size() == count());
  try {
    for (std::size_t i = 0; i < count(); ++i) {
      auto worker = std::make_unique<FetchWorker>(requests, std::move(probes[i]), i, count(),
                                                  &time_now, stopping_, read_ahead);
      const std::lock_guard lock(lanes_[i]->mutex);
      lanes_[i]->served.push_back({requests.data(), std::move(worker)});
    }
    return {};
  } catch (const std::bad_alloc&) {
    remove(requests);
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for fetch threads; free some and try again");
  }
}

void FetchThreads::remove(std::span<const FetchRequests> requests) noexcept {
  for (const auto& lane : lanes_) {
    const std::lock_guard lock(lane->mutex);
    std::erase_if(lane->served, [&requests](const Lane::Served& served) {
      return served.requests == requests.data();
    });
  }
}

FetchThreads::~FetchThreads() {
  stopping_.store(true, std::memory_order_relaxed);
  cache_.wake_helpers();
  for (const auto& lane : lanes_)
    if (lane->thread.joinable()) lane->thread.join();
}

}  // namespace planetree::query
