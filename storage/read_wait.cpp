#include "storage/read_wait.h"

#include <cerrno>

namespace planetree::storage {
namespace {

// Where bytes go at which nobody looks. It outlives every ring.
char unread_byte;

}  // namespace

ReadWait::~ReadWait() {
  if (state_ == State::kIdle || state_ == State::kReading) calls_->io_uring_queue_exit(&ring_);
}

void ReadWait::open(FileCalls& calls) noexcept {
  calls_ = &calls;
  state_ = State::kRefused;
  if (calls.io_uring_queue_init(1, &ring_, 0) != 0) return;
  state_ = State::kIdle;
  // Without it a limit would be a second thing to be read.
  if ((ring_.features & IORING_FEAT_EXT_ARG) != 0) return;
  calls.io_uring_queue_exit(&ring_);
  state_ = State::kRefused;
}

void ReadWait::start(int descriptor, std::uint64_t offset) noexcept {
  io_uring_prep_read(io_uring_get_sqe(&ring_), descriptor, &unread_byte, 1, offset);
  state_ = State::kReading;
}

ReadWait::Outcome ReadWait::wait_for(FileCalls& calls, int descriptor, std::uint64_t offset,
                                     std::chrono::microseconds most) noexcept {
  if (state_ == State::kNew) open(calls);
  if (state_ == State::kRefused) return Outcome::kRefused;
  const auto end = Clock::now() + most;
  if (state_ == State::kReading && wait_until(end) == Outcome::kLate) return Outcome::kLate;
  start(descriptor, offset);
  return wait_until(end);
}

ReadWait::Outcome ReadWait::wait_until(Clock::time_point end) noexcept {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(end - Clock::now());
    if (left.count() <= 0) return Outcome::kLate;
    constexpr std::int64_t kSecond = 1'000'000'000;
    __kernel_timespec most{left.count() / kSecond, left.count() % kSecond};
    io_uring_cqe* completion = nullptr;
    const int outcome = calls_->io_uring_submit_and_wait_timeout(&ring_, &completion, 1, &most);
    if (outcome == -EINTR) continue;
    // What was not told, or has not come, is in the ring, and the next wait is for it.
    if (outcome < 0 || completion == nullptr) return Outcome::kLate;
    const int count = completion->res;
    io_uring_cqe_seen(&ring_, completion);
    state_ = State::kIdle;
    return count < 0 ? Outcome::kRefused : Outcome::kCame;
  }
}

}  // namespace planetree::storage
