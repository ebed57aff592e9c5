#include "storage/system/read_wait.h"

#include <cerrno>

namespace planetree::storage {
namespace {

// Destination of all reads. The value is never used. It outlives every io_uring.
char unread_byte;

}  // namespace

ReadWait::~ReadWait() {
  if (state_ == State::kIdle || state_ == State::kReading) give_up();
}

void ReadWait::open(FileCalls& calls) noexcept {
  calls_ = &calls;
  state_ = State::kRefused;
  if (calls.io_uring_queue_init(1, &ring_, 0) != 0) return;
  state_ = State::kIdle;
  // Without this feature liburing submits each time limit as a second request.
  if ((ring_.features & IORING_FEAT_EXT_ARG) != 0) return;
  give_up();
}

void ReadWait::start(int descriptor, std::uint64_t offset) noexcept {
  io_uring_prep_read(io_uring_get_sqe(&ring_), descriptor, &unread_byte, 1, offset);
  state_ = State::kReading;
}

ReadWait::Outcome ReadWait::wait_until(FileCalls& calls, int descriptor, std::uint64_t offset,
                                       Clock::time_point end) noexcept {
  if (state_ == State::kNew) open(calls);
  if (state_ == State::kReading && finish(end) == Outcome::kLate) return Outcome::kLate;
  if (state_ == State::kRefused) return Outcome::kRefused;
  start(descriptor, offset);
  return finish(end);
}

ReadWait::Outcome ReadWait::finish(Clock::time_point end) noexcept {
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(end - Clock::now());
    if (left.count() <= 0) return Outcome::kLate;
    constexpr std::int64_t kSecond = 1'000'000'000;
    __kernel_timespec max_wait{left.count() / kSecond, left.count() % kSecond};
    io_uring_cqe* completion = nullptr;
    const int outcome = calls_->io_uring_submit_and_wait_timeout(&ring_, &completion, 1, &max_wait);
    if (completion != nullptr) {
      const int count = completion->res;
      io_uring_cqe_seen(&ring_, completion);
      state_ = State::kIdle;
      return count < 0 ? Outcome::kRefused : Outcome::kCame;
    }
    // A read that was not submitted or has not completed stays in the ring. The next wait is for
    // that read.
    if (outcome == -ETIME || outcome == -EAGAIN || outcome == -EBUSY) return Outcome::kLate;
    // A signal ended the call. If it came after the read was submitted, the call did not return
    // -EINTR.
    if (outcome == -EINTR || outcome >= 0) continue;
    give_up();
    return Outcome::kRefused;
  }
}

void ReadWait::give_up() noexcept {
  calls_->io_uring_queue_exit(&ring_);
  state_ = State::kRefused;
}

}  // namespace planetree::storage
