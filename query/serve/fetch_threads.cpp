#include "query/serve/fetch_threads.h"

#include <pthread.h>
#include <sched.h>

#include <chrono>
#include <csignal>
#include <cstddef>
#include <new>
#include <system_error>
#include <utility>

#include "octree/geometry/fp_environment.h"

namespace planetree::query {
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

void FetchThreads::run(FetchWorker& worker) noexcept {
  prefault_stack();
  drop_priority_and_block_signals();
  const octree::FpEnvironmentGuard host;
  Clock::time_point last = Clock::now() - kBusyPeriod;
  while (!stopping_.load(std::memory_order_relaxed)) {
    const FetchWorker::Action action = worker.work();
    if (action == FetchWorker::Action::kReadAwaitedPage) continue;
    if (action == FetchWorker::Action::kNone) {
      cache_.wait_for_wanted_page(Clock::now() - last < kBusyPeriod ? kBusyPause : kIdlePause,
                                  stopping_);
      continue;
    }
    last = Clock::now();
    (action == FetchWorker::Action::kServedRequest ? requests_served_ : positions_prefetched_)
        .fetch_add(1, std::memory_order_relaxed);
  }
}

Result<std::unique_ptr<FetchThreads>> FetchThreads::start(
    cache::PageCache& cache, std::span<FetchRequests> requests,
    std::vector<std::unique_ptr<FetchProbe>> probes) {
  const std::size_t count = probes.size();
  const auto refused = [count] {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "the system refused %zu fetch threads; free memory or lower fetch_threads",
                      count);
  };
  try {
    std::unique_ptr<FetchThreads> threads(new FetchThreads(cache));
    for (std::size_t i = 0; i < count; ++i)
      threads->workers_.push_back(std::make_unique<FetchWorker>(
          requests, std::move(probes[i]), i, count, &time_now, threads->stopping_));
    for (const auto& worker : threads->workers_)
      threads->threads_.emplace_back(
          [&threads = *threads, &worker = *worker] { threads.run(worker); });
    return threads;
  } catch (const std::bad_alloc&) {
    return refused();
  } catch (const std::system_error&) {
    return refused();
  }
}

FetchThreads::~FetchThreads() {
  stopping_.store(true, std::memory_order_relaxed);
  cache_.wake_helpers();
  for (std::thread& thread : threads_) thread.join();
}

}  // namespace planetree::query
