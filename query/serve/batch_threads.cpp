#include "query/serve/batch_threads.h"

#include <algorithm>
#include <new>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>

#include "octree/geometry/fp_environment.h"
#include "planetree/model.h"

namespace planetree::query {
namespace {

// Long enough that the cost of handing over a piece does not matter, and short enough that threads
// do not wait long for the last one.
constexpr std::size_t kPieceQueries = 128;

}  // namespace

// oneTBB writes a warning to standard error if an arena asks for more threads than are allowed. It
// allows as many as there are processors, or the least number that a global_control states; so all
// of ours state the same. The program may have stated fewer, which is kept to.
BatchThreads::BatchThreads(unsigned threads) {
  constexpr auto kAllowed = tbb::global_control::max_allowed_parallelism;
  if (static_cast<int>(threads) > tbb::info::default_concurrency())
    limit_.emplace(kAllowed, std::size_t{OpenOptions::kMaxBatchThreads});
  const std::size_t allowed = tbb::global_control::active_value(kAllowed);
  arena_.initialize(static_cast<int>(std::min<std::size_t>(threads, allowed)));
}

Result<std::unique_ptr<BatchThreads>> BatchThreads::create(unsigned threads) {
  try {
    return std::unique_ptr<BatchThreads>(new BatchThreads(threads));
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for %u batch threads; free some or lower batch_threads", threads);
  }
}

bool BatchThreads::run(const void* batch, std::size_t count, Work work) noexcept {
  // Acquire and release: a batch sees the state that the last batch left in the probes.
  if (busy_.exchange(true, std::memory_order_acquire)) return false;
  const auto do_piece = [&](const tbb::blocked_range<std::size_t>& piece) {
    const octree::FpEnvironmentGuard host;
    const auto thread = static_cast<std::size_t>(tbb::this_task_arena::current_thread_index());
    work(batch, thread, piece.begin(), piece.end());
  };
  bool done = true;
  try {
    arena_.execute([&] {
      tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, kPieceQueries), do_piece,
                        tbb::simple_partitioner());
    });
  } catch (...) {  // oneTBB has no memory; `work` does not throw
    done = false;
  }
  busy_.store(false, std::memory_order_release);
  return done;
}

}  // namespace planetree::query
