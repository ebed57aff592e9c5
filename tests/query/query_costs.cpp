#include "tests/query/query_costs.h"

#include <fcntl.h>
#include <link.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <thread>

#include "tests/cache/allocation_count.h"
#include "tests/query/call_trap.h"
#include "tests/query/lock_count.h"

namespace planetree::query {
namespace {

// Text of a file of the kernel, which has no length.
struct KernelText {
  char text[4096] = {};

  explicit KernelText(const char* path) noexcept {
    const int file = ::open(path, O_RDONLY | O_CLOEXEC);
    if (file < 0) return;
    std::size_t used = 0;
    for (ssize_t got = 1; got > 0; used += static_cast<std::size_t>(got))
      got = std::max<ssize_t>(::read(file, text + used, sizeof text - 1 - used), 0);
    ::close(file);
  }
};

// Page faults of a thread of this process, minor and major.
std::uint64_t faults_of(pid_t thread) noexcept {
  char path[64];
  std::snprintf(path, sizeof path, "/proc/self/task/%d/stat", static_cast<int>(thread));
  const KernelText stat(path);
  // Field 3 is the first one after the name, which is in brackets.
  const char* at = std::strrchr(stat.text, ')');
  std::uint64_t faults = 0;
  for (int field = 3; at != nullptr && field <= 12; ++field) {
    at = std::strchr(at + 1, ' ');
    if (at != nullptr && (field == 10 || field == 12)) faults += std::strtoull(at, nullptr, 10);
  }
  return faults;
}

// Stage of the querying thread. That thread can only wait by polling, because its system calls are
// trapped.
enum class Stage : int { kWarmingUp, kReady, kQuerying, kDone, kOver };

void wait_busily(const std::atomic<Stage>& stage, Stage wanted) noexcept {
  while (stage.load(std::memory_order_acquire) != wanted) {
  }
}

template <class Look>
void wait_asleep(const std::atomic<Stage>& stage, Stage wanted, const Look& look) noexcept {
  while (stage.load(std::memory_order_acquire) != wanted) {
    look();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

// Stack of the querying thread, which is not part of the model's memory.
constexpr std::size_t kStackBytes = std::size_t{1} << 17;

// Writes to the whole stack, as a real-time thread does at its start. How much stack a query needs
// depends on the pages that are resident, so the warm-up queries may need less than the counted
// ones.
[[gnu::noinline]] void touch_stack() noexcept {
  volatile std::byte stack[kStackBytes];
  for (std::size_t at = 0; at < sizeof stack; at += 64) stack[at] = std::byte{};
}

// Reads all code, as a thread that locks its memory does: code that no query has run yet is not
// mapped.
void touch_code() noexcept {
  using Header = ElfW(Phdr);
  const auto access = [](dl_phdr_info* object, std::size_t, void*) {
    for (const Header& part : std::span(object->dlpi_phdr, object->dlpi_phnum)) {
      if (part.p_type != PT_LOAD || (part.p_flags & PF_X) == 0) continue;
      const auto address = object->dlpi_addr + part.p_vaddr;
      // NOLINTNEXTLINE(performance-no-int-to-ptr): the loader gives addresses as numbers.
      const auto* bytes = reinterpret_cast<const volatile std::byte*>(address);
      for (std::size_t at = 0; at < part.p_memsz; at += 4096) (void)bytes[at];
    }
    return 0;
  };
  ::dl_iterate_phdr(access, nullptr);
}

constexpr QueryOptions kNow{.wait = Wait::kNever};

// Queries that take longer than one for the closest point: of sets, of rays and of moving balls.
void run_long_queries(Probe& probe, const Vec3& point, const Vec3& next) noexcept {
  std::array<ClosestPoint, 16> found;
  std::array<RayHit, 16> hits;
  probe.contacts(point, 0.3, found, kNow);
  probe.nearest_triangles(point, found, kNow);
  probe.triangles_within(point, 0.1, found, kNow);
  probe.triangles_within(Box{point, {point.x + 0.1, point.y + 0.1, point.z + 0.1}}, found, kNow);
  const Ray ray{point, {next.x - point.x, next.y - point.y, next.z - point.z}};
  probe.first_hit(ray, kNow);
  probe.all_hits(ray, hits, kNow);
  probe.first_contact({point, next, 0.01}, kNow);
}

std::uint64_t run_queries(Probe& probe, std::span<const Vec3> points,
                          std::uint64_t queries) noexcept {
  constexpr std::uint64_t kPointsForLong = 8;
  std::uint64_t degraded = 0;
  for (std::uint64_t i = 0; i < queries; ++i) {
    const Vec3& point = points[i % points.size()];
    degraded += probe.closest_point(point, kNow).status == Status::kDegraded;
    probe.contains(point, kNow);
    if (i % kPointsForLong == 0) run_long_queries(probe, point, points[(i + 1) % points.size()]);
    probe.motion(point, {1, 0, 0});
  }
  return degraded;
}

std::uint64_t excess(std::uint64_t value, std::uint64_t limit) noexcept {
  return value > limit ? value - limit : 0;
}

}  // namespace

std::uint64_t resident_memory_bytes() noexcept {
  const KernelText sums("/proc/self/smaps_rollup");
  const char* at = std::strstr(sums.text, "\nAnonymous:");
  return at == nullptr ? 0 : 1024 * std::strtoull(at + sizeof "Anonymous:", nullptr, 10);
}

QueryCosts measure_queries(const Model& model, Probe& probe, std::span<const Vec3> points,
                           std::uint64_t warm_up, std::uint64_t queries,
                           std::uint64_t resident_bytes) {
  QueryCosts costs;
  costs.queries = queries;
  std::atomic<Stage> stage{Stage::kWarmingUp};
  std::atomic<pid_t> id{0};
  std::thread thread([&] {
    id = ::gettid();
    touch_code();
    touch_stack();
    (void)run_queries(probe, points, warm_up);
    costs.calls_are_counted = set_call_trap();
    stage.store(Stage::kReady, std::memory_order_release);
    wait_busily(stage, Stage::kQuerying);
    const std::uint64_t locks = lock_count(), calls = trapped_calls();
    costs.degraded = run_queries(probe, points, queries);
    costs.locks = lock_count() - locks;
    costs.calls = trapped_calls() - calls;
    stage.store(Stage::kDone, std::memory_order_release);
    wait_busily(stage, Stage::kOver);
  });
  wait_asleep(stage, Stage::kReady, [] {});
  const Stats before = model.stats();
  const std::uint64_t faults = faults_of(id), resident = resident_memory_bytes();
  const std::uint64_t allocations = cache::allocation_count();
  std::uint64_t most = resident;
  stage.store(Stage::kQuerying, std::memory_order_release);
  wait_asleep(stage, Stage::kDone, [&] { most = std::max(most, resident_memory_bytes()); });
  most = std::max(most, resident_memory_bytes());
  costs.allocations = cache::allocation_count() - allocations;
  costs.faults = faults_of(id) - faults;
  stage.store(Stage::kOver, std::memory_order_release);
  thread.join();
  const Stats after = model.stats();
  costs.pages_read = after.pages_read - before.pages_read;
  costs.pages_evicted = after.pages_evicted - before.pages_evicted;
  costs.grown_bytes = excess(most, resident);
  costs.over_budget_bytes =
      std::max(excess(after.arena_bytes + after.table_bytes, after.budget_bytes),
               excess(most, resident_bytes + kStackBytes + after.budget_bytes));
  return costs;
}

}  // namespace planetree::query
