#pragma once

#include <liburing.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "storage/system/file_calls.h"

namespace planetree::storage {

/// The system, of which io_uring can be refused, interrupted, or made to stand still.
class RingCalls : public FileCalls {
 public:
  bool refuses = false;
  bool knows_no_limits = false;  ///< as systems before 5.11
  bool stands_still = false;     ///< time goes by, and nothing comes
  int interruptions = 0;         ///< by signals, before anything comes
  int silent_interruptions = 0;  ///< likewise, that say nothing of signals
  bool refuses_to_wait = false;
  std::chrono::milliseconds time_of_waits{0};
  int rings = 0, rings_gone = 0, waits = 0;
  std::chrono::nanoseconds longest_wait{0};  ///< that was asked for

  int io_uring_queue_init(unsigned entries, io_uring* ring, unsigned flags) noexcept override {
    ++rings;
    if (refuses) return -EPERM;
    const int outcome = FileCalls::io_uring_queue_init(entries, ring, flags);
    if (knows_no_limits) ring->features &= ~static_cast<unsigned>(IORING_FEAT_EXT_ARG);
    return outcome;
  }
  int io_uring_submit_and_wait_timeout(io_uring* ring, io_uring_cqe** completion, unsigned count,
                                       __kernel_timespec* most) noexcept override {
    ++waits;
    const std::chrono::nanoseconds queried =
        std::chrono::seconds(most->tv_sec) + std::chrono::nanoseconds(most->tv_nsec);
    if (queried > longest_wait) longest_wait = queried;
    if (time_of_waits.count() > 0) std::this_thread::sleep_for(time_of_waits);
    if (refuses_to_wait) return -EPERM;
    if (stands_still) return -ETIME;
    if (silent_interruptions > 0) {
      --silent_interruptions;
      return 0;
    }
    if (interruptions > 0) {
      --interruptions;
      return -EINTR;
    }
    return FileCalls::io_uring_submit_and_wait_timeout(ring, completion, count, most);
  }
  void io_uring_queue_exit(io_uring* ring) noexcept override {
    ++rings_gone;
    FileCalls::io_uring_queue_exit(ring);
  }

  /// Whether the tests' own system has what is wanted of it. Not where it is forbidden, as in
  /// some containers: there the library goes without.
  static bool are_to_be_had() {
    io_uring ring;
    if (::io_uring_queue_init(1, &ring, 0) != 0) return false;
    const bool good = (ring.features & IORING_FEAT_EXT_ARG) != 0;
    ::io_uring_queue_exit(&ring);
    return good;
  }
};

}  // namespace planetree::storage
