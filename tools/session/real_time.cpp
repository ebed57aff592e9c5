#include "tools/session/real_time.h"

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>

namespace planetree::tools {
namespace {

bool pin_to_last_processor() noexcept {
  cpu_set_t allowed;
  if (::sched_getaffinity(0, sizeof allowed, &allowed) != 0) return false;
  int last = -1;
  for (int cpu = 0; cpu < CPU_SETSIZE; ++cpu)
    if (CPU_ISSET(static_cast<std::size_t>(cpu), &allowed)) last = cpu;
  if (last < 0) return false;
  cpu_set_t one;
  CPU_ZERO(&one);
  CPU_SET(static_cast<std::size_t>(last), &one);
  return ::pthread_setaffinity_np(::pthread_self(), sizeof one, &one) == 0;
}

}  // namespace

RealTimeRights become_real_time() noexcept {
  RealTimeRights rights;
  rights.pinned = pin_to_last_processor();
  sched_param parameters{};
  parameters.sched_priority = ::sched_get_priority_min(SCHED_FIFO) + 20;
  rights.fifo = ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &parameters) == 0;
  return rights;
}

ThreadUsage thread_usage() noexcept {
  rusage usage{};
  ::getrusage(RUSAGE_THREAD, &usage);
  return {static_cast<std::uint64_t>(usage.ru_minflt + usage.ru_majflt),
          static_cast<std::uint64_t>(usage.ru_nvcsw), static_cast<std::uint64_t>(usage.ru_nivcsw)};
}

}  // namespace planetree::tools
