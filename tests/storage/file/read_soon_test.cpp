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

  explicit ForgetfulCalls(int looks_in_vain, int errno_of_those = EAGAIN,
                          std::chrono::milliseconds time_of_those = {})
      : looks_in_vain_(looks_in_vain),
        errno_of_those_(errno_of_those),
        time_of_those_(time_of_those) {}

  int looks = 0, certain = 0;
  off_t told_offset = 0, told_bytes = 0;

  ssize_t preadv2(int descriptor, const iovec* parts, int part_count, off_t offset,
                  int flags) noexcept override {
    EXPECT_EQ(flags, RWF_NOWAIT);
    EXPECT_EQ(part_count, 1);
    const bool in_vain = looks++ < looks_in_vain_;
    if (in_vain && time_of_those_.count() > 0) std::this_thread::sleep_for(time_of_those_);
    if (in_vain && errno_of_those_ == kEnd) return 0;
    if (in_vain && errno_of_those_ != 0) {
      errno = errno_of_those_;
      return -1;
    }
    const ssize_t count = FileCalls::pread(descriptor, parts->iov_base, parts->iov_len, offset);
    return in_vain ? count - 1 : count;
  }
  int posix_fadvise(int, off_t offset, off_t bytes, int advice) noexcept override {
    EXPECT_EQ(advice, POSIX_FADV_WILLNEED);
    EXPECT_EQ(looks, 1);
    ++certain;
    told_offset = offset;
    told_bytes = bytes;
    return 0;
  }

 private:
  const int looks_in_vain_;
  const int errno_of_those_;  // errno; 0: all bytes but the last; kEnd: the file's end
  const std::chrono::milliseconds time_of_those_;
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

  const PageEntry& entry() const { return file_->entries()[1]; }
  /// Returns whether the page was read in time.
  bool read(const SoonTerms& terms = {}) const {
    Bytes stored(file_->header().max_stored_bytes), raw(entry().raw_bytes);
    const Result<bool> read = file_->read_page_soon(1, stored, raw, terms);
    EXPECT_TRUE(read);
    const bool had = read && *read;
    EXPECT_EQ(had, raw == sample_.raw(1));
    return had;
  }
  bool refuses_pages_beyond() const {
    Bytes stored(file_->header().max_stored_bytes), raw(entry().raw_bytes);
    return !file_->read_page_soon(file_->page_count(), stored, raw);
  }

 private:
  const TemporaryDirectory directory_;
  const SampleFile sample_;
  std::optional<PageFile> file_;
};

TEST(ReadSoon, ReadsWhatTheSystemHasWithNoOtherCall) {
  ForgetfulCalls calls(0);
  const PageSoon page(calls);
  ReadWait wait;
  EXPECT_TRUE(page.read({.wait = &wait}));
  EXPECT_EQ(calls.looks, 1);
  EXPECT_EQ(calls.certain + calls.rings, 0);
  EXPECT_TRUE(page.refuses_pages_beyond());
}

TEST(ReadSoon, LooksAgainOnceItWasTold) {
  for (const int errno_of_those : {EAGAIN, 0}) {
    ForgetfulCalls calls(1, errno_of_those);
    const PageSoon page(calls);
    EXPECT_TRUE(page.read());
    EXPECT_EQ(calls.looks, 2);
    EXPECT_EQ(calls.certain, 1);
    EXPECT_EQ(calls.told_offset, static_cast<off_t>(page.entry().offset));
    EXPECT_EQ(calls.told_bytes, static_cast<off_t>(page.entry().stored_bytes));
  }
}

// An attempt may take long itself: the time is limited, not only the number of attempts.
TEST(ReadSoon, DoesNotLookForLong) {
  for (const int errno_of_those : {EAGAIN, 0}) {
    ForgetfulCalls calls(1 << 20, errno_of_those, std::chrono::milliseconds(1));
    EXPECT_FALSE(PageSoon(calls).read());
    EXPECT_EQ(calls.looks, 2);
    EXPECT_EQ(calls.certain, 1);
  }
}

TEST(ReadSoon, LooksOnceWhereTheSystemCannotTellOrFailsOrTheFileEnds) {
  for (const int errno_of_those : {EOPNOTSUPP, EIO, ForgetfulCalls::kEnd}) {
    ForgetfulCalls calls(1 << 20, errno_of_those);
    ReadWait wait;
    EXPECT_FALSE(PageSoon(calls).read({.wait = &wait, .max_waited = std::chrono::minutes(10)}));
    EXPECT_EQ(calls.looks, 1);
    EXPECT_EQ(calls.certain + calls.rings, 0);
  }
}

TEST(ReadSoon, LooksAgainAndAgainAsLongAsItMay) {
  ForgetfulCalls calls(100);
  EXPECT_TRUE(PageSoon(calls).read({.max_looked = std::chrono::minutes(10)}));
  EXPECT_EQ(calls.looks, 101);
  EXPECT_EQ(calls.certain, 1);
}

class ReadSoonByAWait : public testing::Test {
 protected:
  void SetUp() override {
    if (!RingCalls::are_to_be_had()) GTEST_SKIP() << "the system refuses io_uring";
  }
  // `calls` outlives the ReadWait that uses it.
  static bool read(ForgetfulCalls& calls,
                   std::chrono::milliseconds max_waited = std::chrono::minutes(10)) {
    ReadWait wait;
    return PageSoon(calls).read(
        {.max_looked = std::chrono::minutes(10), .wait = &wait, .max_waited = max_waited});
  }
};

TEST_F(ReadSoonByAWait, LooksOnceMoreAfterEachWait) {
  for (const int errno_of_those : {EAGAIN, 0})
    for (const int waits : {1, 3}) {
      ForgetfulCalls calls(waits, errno_of_those);
      ReadWait wait;
      EXPECT_TRUE(PageSoon(calls).read({.wait = &wait, .max_waited = std::chrono::minutes(10)}));
      EXPECT_EQ(calls.looks, 1 + waits);
      EXPECT_EQ(calls.certain, 1);
      EXPECT_EQ(calls.waits, waits);
    }
}

TEST_F(ReadSoonByAWait, LooksForWhatComesLater) {
  ForgetfulCalls calls(100);
  EXPECT_TRUE(read(calls));
  EXPECT_EQ(calls.looks, 101);
  EXPECT_EQ(calls.waits, 4);
}

TEST_F(ReadSoonByAWait, LooksWhereWaitingIsRefused) {
  ForgetfulCalls calls(100);
  calls.refuses = true;
  EXPECT_TRUE(read(calls));
  EXPECT_EQ(calls.looks, 101);
  EXPECT_EQ(calls.waits, 0);
}

TEST_F(ReadSoonByAWait, LooksOnceForWhatItHasWaitedForInVain) {
  for (const int looks_in_vain : {1, 2}) {
    ForgetfulCalls calls(looks_in_vain);
    calls.stands_still = true;
    EXPECT_EQ(read(calls), looks_in_vain == 1);
    EXPECT_EQ(calls.looks, 2);
    EXPECT_EQ(calls.waits, 1);
  }
}

// The limit holds for all waits together, not for each.
TEST_F(ReadSoonByAWait, WaitsNoLongerThanTheLimitInAll) {
  ForgetfulCalls calls(1 << 20);
  calls.time_of_waits = std::chrono::milliseconds(30);
  EXPECT_FALSE(read(calls, std::chrono::milliseconds(40)));
  EXPECT_LE(calls.waits, 2);
}

}  // namespace
}  // namespace planetree::storage
