#include "storage/system/read_wait.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <optional>

#include "storage/system/file_handle.h"
#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/ring_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

using Outcome = ReadWait::Outcome;
constexpr std::chrono::minutes kLong{10};
constexpr std::chrono::milliseconds kShort{2};

std::chrono::steady_clock::time_point in(std::chrono::microseconds max_wait) {
  return std::chrono::steady_clock::now() + max_wait;
}

/// A pipe: a read of it waits until a byte is written.
struct Pipe {
  Pipe() { EXPECT_EQ(::pipe(ends), 0); }
  ~Pipe() {
    ::close(ends[0]);
    ::close(ends[1]);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  void write_byte() const { EXPECT_EQ(::write(ends[1], "x", 1), 1); }

  int ends[2];
};

class ReadWaitTest : public testing::Test {
 protected:
  void SetUp() override {
    if (!RingCalls::are_available()) GTEST_SKIP() << "the system refuses io_uring";
    wait_.emplace();
    ASSERT_TRUE(SampleFile().write(directory_ / "a.ptree"));
    file_ =
        FileHandle::open(FileCalls::real(), AT_FDCWD, (directory_ / "a.ptree").c_str(), O_RDONLY);
  }
  Outcome wait_for_the_file(std::uint64_t offset = 0) {
    return wait_->wait_until(calls_, file_.descriptor(), offset, in(kLong));
  }
  Outcome wait_for(const Pipe& pipe, std::chrono::microseconds max_wait) {
    return wait_->wait_until(calls_, pipe.ends[0], 0, in(max_wait));
  }

  const TemporaryDirectory directory_;
  RingCalls calls_;
  FileHandle file_;
  std::optional<ReadWait> wait_;
};

TEST_F(ReadWaitTest, EndsWhenBytesArrive) {
  EXPECT_EQ(calls_.rings, 0);
  for (const std::uint64_t offset : {0, 1, 5000})
    EXPECT_EQ(wait_for_the_file(offset), Outcome::kCame);
  EXPECT_EQ(calls_.rings, 1);
  EXPECT_EQ(calls_.waits, 3);
  wait_.reset();
  EXPECT_EQ(calls_.rings_destroyed, 1);
}

TEST_F(ReadWaitTest, CreatesNoRingUnlessUsed) {
  wait_.reset();
  EXPECT_EQ(calls_.rings + calls_.rings_destroyed, 0);
}

TEST_F(ReadWaitTest, TriesARefusedRingOnlyOnce) {
  calls_.refuses = true;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(wait_for_the_file(), Outcome::kRefused);
  wait_.reset();
  EXPECT_EQ(calls_.rings, 1);
  EXPECT_EQ(calls_.waits + calls_.rings_destroyed, 0);
}

TEST_F(ReadWaitTest, IsRefusedWithoutTimeoutSupport) {
  calls_.lacks_timeouts = true;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(wait_for_the_file(), Outcome::kRefused);
  wait_.reset();
  EXPECT_EQ(calls_.rings, 1);
  EXPECT_EQ(calls_.waits, 0);
  EXPECT_EQ(calls_.rings_destroyed, 1);
}

TEST_F(ReadWaitTest, IsRefusedForAnUnreadableDescriptor) {
  EXPECT_EQ(wait_->wait_until(calls_, -1, 0, in(kLong)), Outcome::kRefused);
  EXPECT_EQ(wait_for_the_file(), Outcome::kCame);
}

TEST_F(ReadWaitTest, ContinuesAfterSignals) {
  calls_.interruptions = 3;
  EXPECT_EQ(wait_for_the_file(), Outcome::kCame);
  EXPECT_EQ(calls_.waits, 4);
}

// If the call has already submitted a request, a signal ends the wait without an error.
TEST_F(ReadWaitTest, ContinuesAfterSignalsReportedWithoutError) {
  calls_.silent_interruptions = 3;
  EXPECT_EQ(wait_for_the_file(), Outcome::kCame);
  EXPECT_EQ(calls_.waits, 4);
}

TEST_F(ReadWaitTest, IsRefusedForGoodAfterALaterRefusal) {
  EXPECT_EQ(wait_for_the_file(), Outcome::kCame);
  calls_.refuses_to_wait = true;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(wait_for_the_file(), Outcome::kRefused);
  EXPECT_EQ(calls_.waits, 2);
  wait_.reset();
  EXPECT_EQ(calls_.rings_destroyed, 1);
}

TEST_F(ReadWaitTest, IsNeverLongerThanItsLimit) {
  const Pipe pipe;
  EXPECT_EQ(wait_for(pipe, kShort), Outcome::kLate);
  EXPECT_LE(calls_.longest_wait, kShort);
  EXPECT_EQ(wait_for(pipe, {}), Outcome::kLate);
}

TEST_F(ReadWaitTest, WaitsForALateReadBeforeTheNext) {
  const Pipe pipe;
  EXPECT_EQ(wait_for(pipe, kShort), Outcome::kLate);
  EXPECT_EQ(wait_->wait_until(calls_, file_.descriptor(), 0, in(kShort)), Outcome::kLate);
  pipe.write_byte();
  EXPECT_EQ(wait_for_the_file(), Outcome::kCame);
  // Only one read of the pipe was started, and it consumed the byte.
  EXPECT_EQ(wait_for(pipe, kShort), Outcome::kLate);
}

TEST_F(ReadWaitTest, ContinuesARequestThatWasNotStarted) {
  calls_.stalls = true;
  EXPECT_EQ(wait_for_the_file(), Outcome::kLate);
  EXPECT_EQ(wait_for_the_file(), Outcome::kLate);
  calls_.stalls = false;
  calls_.waits = 0;
  EXPECT_EQ(wait_for_the_file(), Outcome::kCame);
  EXPECT_EQ(calls_.waits, 2);
}

TEST_F(ReadWaitTest, MayBeDestroyedBeforeALateReadEnds) {
  const Pipe pipe;
  EXPECT_EQ(wait_for(pipe, kShort), Outcome::kLate);
  wait_.reset();
  EXPECT_EQ(calls_.rings_destroyed, 1);
  pipe.write_byte();
}

}  // namespace
}  // namespace planetree::storage
