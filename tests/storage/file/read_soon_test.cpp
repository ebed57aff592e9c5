// Reads of pages that the system may not have in memory.

#include <fcntl.h>
#include <gtest/gtest.h>

#include <cerrno>
#include <chrono>
#include <optional>
#include <thread>

#include "storage/file/page_file.h"
#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/ring_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

/// A system that has bytes in memory only after a number of attempts to read them.
class ForgetfulCalls final : public RingCalls {
 public:
  static constexpr int kEnd = -1;

  explicit ForgetfulCalls(int failing_attempts, int errno_of_failures = EAGAIN,
                          std::chrono::milliseconds time_of_failures = {})
      : failing_attempts_(failing_attempts),
        errno_of_failures_(errno_of_failures),
        time_of_failures_(time_of_failures) {}

  int attempts = 0, advised = 0;
  off_t advised_offset = 0, advised_bytes = 0;

  ssize_t preadv2(int descriptor, const iovec* parts, int part_count, off_t offset,
                  int flags) noexcept override {
    EXPECT_EQ(flags, RWF_NOWAIT);
    EXPECT_EQ(part_count, 1);
    const bool fails = attempts++ < failing_attempts_;
    if (fails && time_of_failures_.count() > 0) std::this_thread::sleep_for(time_of_failures_);
    if (fails && errno_of_failures_ == kEnd) return 0;
    if (fails && errno_of_failures_ != 0) {
      errno = errno_of_failures_;
      return -1;
    }
    const ssize_t count = FileCalls::pread(descriptor, parts->iov_base, parts->iov_len, offset);
    return fails ? count - 1 : count;
  }
  int posix_fadvise(int, off_t offset, off_t bytes, int advice) noexcept override {
    EXPECT_EQ(advice, POSIX_FADV_WILLNEED);
    EXPECT_EQ(attempts, 1);
    ++advised;
    advised_offset = offset;
    advised_bytes = bytes;
    return 0;
  }

 private:
  const int failing_attempts_;
  const int errno_of_failures_;  // errno; 0: all bytes but the last; kEnd: the file's end
  const std::chrono::milliseconds time_of_failures_;
};

/// Reads page 1 of a sample file.
class PageSoon {
 public:
  explicit PageSoon(ForgetfulCalls& calls) {
    EXPECT_TRUE(sample_.write(directory_ / "a.ptree"));
    Result<PageFile> file = PageFile::open(directory_ / "a.ptree", calls);
    EXPECT_TRUE(file);
    if (file) file_.emplace(*std::move(file));
  }

  PageEntry entry() const { return *file_->entry(1); }
  /// Returns whether the page was read in time.
  bool read(const ReadLimits& terms = {}) const {
    Bytes stored(file_->header().max_stored_bytes), raw(entry().raw_bytes);
    const Result<bool> read = file_->try_read_page(1, stored, raw, terms);
    EXPECT_TRUE(read);
    const bool had = read && *read;
    EXPECT_EQ(had, raw == sample_.raw(1));
    return had;
  }
  bool refuses_pages_beyond() const {
    Bytes stored(file_->header().max_stored_bytes), raw(entry().raw_bytes);
    return !file_->try_read_page(file_->page_count(), stored, raw);
  }

 private:
  const TemporaryDirectory directory_;
  const SampleFile sample_;
  std::optional<PageFile> file_;
};

TEST(ReadSoon, ReadsBytesInMemoryWithASingleCall) {
  ForgetfulCalls calls(0);
  const PageSoon page(calls);
  ReadWait wait;
  EXPECT_TRUE(page.read({.wait = &wait}));
  EXPECT_EQ(calls.attempts, 1);
  EXPECT_EQ(calls.advised + calls.rings, 0);
  EXPECT_TRUE(page.refuses_pages_beyond());
}

TEST(ReadSoon, RetriesOnceAfterReadAheadAdvice) {
  for (const int errno_of_failures : {EAGAIN, 0}) {
    ForgetfulCalls calls(1, errno_of_failures);
    const PageSoon page(calls);
    EXPECT_TRUE(page.read());
    EXPECT_EQ(calls.attempts, 2);
    EXPECT_EQ(calls.advised, 1);
    EXPECT_EQ(calls.advised_offset, static_cast<off_t>(page.entry().offset));
    EXPECT_EQ(calls.advised_bytes, static_cast<off_t>(page.entry().stored_bytes));
  }
}

// An attempt may take long itself: the time is limited, not only the number of attempts.
TEST(ReadSoon, StopsPollingAtTheTimeLimit) {
  for (const int errno_of_failures : {EAGAIN, 0}) {
    ForgetfulCalls calls(1 << 20, errno_of_failures, std::chrono::milliseconds(1));
    EXPECT_FALSE(PageSoon(calls).read());
    EXPECT_EQ(calls.attempts, 2);
    EXPECT_EQ(calls.advised, 1);
  }
}

TEST(ReadSoon, PollsOnceWherePollingIsUnsupportedOrFails) {
  for (const int errno_of_failures : {EOPNOTSUPP, EIO, ForgetfulCalls::kEnd}) {
    ForgetfulCalls calls(1 << 20, errno_of_failures);
    ReadWait wait;
    EXPECT_FALSE(PageSoon(calls).read({.wait = &wait, .max_wait = std::chrono::minutes(10)}));
    EXPECT_EQ(calls.attempts, 1);
    EXPECT_EQ(calls.advised + calls.rings, 0);
  }
}

TEST(ReadSoon, PollsUntilTheTimeLimit) {
  ForgetfulCalls calls(100);
  EXPECT_TRUE(PageSoon(calls).read({.max_poll = std::chrono::minutes(10)}));
  EXPECT_EQ(calls.attempts, 101);
  EXPECT_EQ(calls.advised, 1);
}

class ReadSoonWithAWait : public testing::Test {
 protected:
  void SetUp() override {
    if (!RingCalls::are_available()) GTEST_SKIP() << "the system refuses io_uring";
  }
  // `calls` outlives the ReadWait that uses it.
  static bool read(ForgetfulCalls& calls,
                   std::chrono::milliseconds max_wait = std::chrono::minutes(10)) {
    ReadWait wait;
    return PageSoon(calls).read(
        {.max_poll = std::chrono::minutes(10), .wait = &wait, .max_wait = max_wait});
  }
};

TEST_F(ReadSoonWithAWait, ReadsOnceMoreAfterEachWait) {
  for (const int errno_of_failures : {EAGAIN, 0})
    for (const int waits : {1, 3}) {
      ForgetfulCalls calls(waits, errno_of_failures);
      ReadWait wait;
      EXPECT_TRUE(PageSoon(calls).read({.wait = &wait, .max_wait = std::chrono::minutes(10)}));
      EXPECT_EQ(calls.attempts, 1 + waits);
      EXPECT_EQ(calls.advised, 1);
      EXPECT_EQ(calls.waits, waits);
    }
}

TEST_F(ReadSoonWithAWait, PollsAfterTheWaitsUntilTheBytesArrive) {
  ForgetfulCalls calls(100);
  EXPECT_TRUE(read(calls));
  EXPECT_EQ(calls.attempts, 101);
  EXPECT_EQ(calls.waits, 4);
}

TEST_F(ReadSoonWithAWait, PollsWhereIoUringIsRefused) {
  ForgetfulCalls calls(100);
  calls.refuses = true;
  EXPECT_TRUE(read(calls));
  EXPECT_EQ(calls.attempts, 101);
  EXPECT_EQ(calls.waits, 0);
}

TEST_F(ReadSoonWithAWait, ReadsOnceMoreAfterAWaitThatTimedOut) {
  for (const int failing_attempts : {1, 2}) {
    ForgetfulCalls calls(failing_attempts);
    calls.stalls = true;
    EXPECT_EQ(read(calls), failing_attempts == 1);
    EXPECT_EQ(calls.attempts, 2);
    EXPECT_EQ(calls.waits, 1);
  }
}

// The limit holds for all waits together, not for each.
TEST_F(ReadSoonWithAWait, WaitsInTotalNoLongerThanTheLimit) {
  ForgetfulCalls calls(1 << 20);
  calls.time_of_waits = std::chrono::milliseconds(30);
  EXPECT_FALSE(read(calls, std::chrono::milliseconds(40)));
  EXPECT_LE(calls.waits, 2);
}

}  // namespace
}  // namespace planetree::storage
