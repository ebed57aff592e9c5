#pragma once

#include <liburing.h>

#include <cerrno>
#include <chrono>
#include <thread>

#include "storage/system/file_calls.h"

namespace planetree::storage {

/// The system with an io_uring that can be refused, interrupted, or made to stall.
class RingCalls : public FileCalls {
 public:
  bool refuses = false;
  bool lacks_timeouts = false;   ///< as systems before 5.11: no timeout for waits
  bool stalls = false;           ///< waits time out and no completion arrives
  int interruptions = 0;         ///< number of waits interrupted by signals
  int silent_interruptions = 0;  ///< number of waits interrupted without an error
  bool refuses_to_wait = false;
  std::chrono::milliseconds time_of_waits{0};
  int rings = 0, rings_destroyed = 0, waits = 0;
  std::chrono::nanoseconds longest_wait{0};  ///< longest timeout requested

  int io_uring_queue_init(unsigned entries, io_uring* ring, unsigned flags) noexcept override {
    ++rings;
    if (refuses) return -EPERM;
    const int outcome = FileCalls::io_uring_queue_init(entries, ring, flags);
    if (lacks_timeouts) ring->features &= ~static_cast<unsigned>(IORING_FEAT_EXT_ARG);
    return outcome;
  }
  int io_uring_submit_and_wait_timeout(io_uring* ring, io_uring_cqe** completion, unsigned count,
                                       __kernel_timespec* max_wait) noexcept override {
    ++waits;
    const std::chrono::nanoseconds requested =
        std::chrono::seconds(max_wait->tv_sec) + std::chrono::nanoseconds(max_wait->tv_nsec);
    if (requested > longest_wait) longest_wait = requested;
    if (time_of_waits.count() > 0) std::this_thread::sleep_for(time_of_waits);
    if (refuses_to_wait) return -EPERM;
    if (stalls) return -ETIME;
    if (silent_interruptions > 0) {
      --silent_interruptions;
      return 0;
    }
    if (interruptions > 0) {
      --interruptions;
      return -EINTR;
    }
    return FileCalls::io_uring_submit_and_wait_timeout(ring, completion, count, max_wait);
  }
  void io_uring_queue_exit(io_uring* ring) noexcept override {
    ++rings_destroyed;
    FileCalls::io_uring_queue_exit(ring);
  }

  /// Whether this machine's io_uring has what ReadWait needs. Some containers forbid io_uring; the
  /// library then works without it.
  static bool are_available() {
    io_uring ring;
    if (::io_uring_queue_init(1, &ring, 0) != 0) return false;
    const bool good = (ring.features & IORING_FEAT_EXT_ARG) != 0;
    ::io_uring_queue_exit(&ring);
    return good;
  }
};

}  // namespace planetree::storage
