#include <gtest/gtest.h>

#include "storage/system/mapping.h"
#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

/// Every system call of opening and reading a file fails once.
namespace planetree::storage {
namespace {

using Fault = FaultyCalls::Fault;

class ReadFaults : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(sample_.write(path_)); }

  // Fails the n-th call for every n until a run has no fault; returns the number of calls.
  template <class Check>
  int for_every_call(Fault fault, int number, bool every, Check check) {
    for (int fault_at = 0;; ++fault_at) {
      FaultyCalls calls;
      calls.fault = fault;
      calls.number = number;
      calls.fault_at = fault_at;
      calls.every = every;
      const Result<std::vector<Bytes>> pages = read_all(path_, calls);
      if (pages) {
        EXPECT_EQ(pages->size(), sample_.page_count);
        for (std::uint32_t page = 0; page < sample_.page_count; ++page) {
          EXPECT_EQ((*pages)[page], sample_.raw(page));
        }
      }
      if (!calls.happened()) {
        EXPECT_TRUE(pages);
        return fault_at;
      }
      check(calls, pages);
    }
  }

  SampleFile sample_;
  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "a.ptree";
};

TEST_F(ReadFaults, AFailedCallIsACleanError) {
  int error_count = 0;
  const int call_count = for_every_call(
      Fault::kError, EIO, false,
      [&](const FaultyCalls& calls, const Result<std::vector<Bytes>>& pages) {
        const bool harmless = calls.failed_call() == "munmap" || calls.failed_call() == "close";
        EXPECT_EQ(bool(pages), harmless) << calls.failed_call();
        if (pages) return;
        ++error_count;
        EXPECT_EQ(pages.error().code, ErrorCode::kReadFailed);
        if (calls.failed_call() == "pread") {
          // The directory is read first; it is in front of the pages.
          const Error& error = pages.error();
          EXPECT_EQ(error.page<sample_.page_count, error.offset> kHeaderBytes);
          EXPECT_NE(error.offset, Error::kNowhere);
        }
      });
  EXPECT_GE(call_count, 12);
  EXPECT_GE(error_count, 8);
}

// madvise() reports bad sectors as EFAULT, and EINVAL where the system does not know the advice.
TEST_F(ReadFaults, ABadSectorUnderAMapIsAnError) {
  int bad = 0;
  for_every_call(Fault::kError, EFAULT, false,
                 [&](const FaultyCalls& calls, const Result<std::vector<Bytes>>& pages) {
                   if (calls.failed_call() != "madvise") return;
                   ++bad;
                   ASSERT_FALSE(pages);
                   EXPECT_EQ(pages.error().code, ErrorCode::kReadFailed);
                 });
  EXPECT_EQ(bad, 2);
  for_every_call(Fault::kError, EINVAL, false,
                 [&](const FaultyCalls& calls, const Result<std::vector<Bytes>>& pages) {
                   if (calls.failed_call() == "madvise") {
                     EXPECT_TRUE(pages);
                   }
                 });
}

TEST_F(ReadFaults, AnInterruptedCallIsResumed) {
  const int call_count =
      for_every_call(Fault::kInterrupt, EINTR, false,
                     [](const FaultyCalls& calls, const Result<std::vector<Bytes>>& pages) {
                       EXPECT_TRUE(pages) << calls.failed_call();
                     });
  EXPECT_EQ(call_count, 7);  // one open, two maps populated, directory and three pages read
}

TEST_F(ReadFaults, AShortReadIsResumed) {
  for (const bool every : {false, true}) {
    const int call_count = for_every_call(
        Fault::kShort, 0, every,
        [](const FaultyCalls&, const Result<std::vector<Bytes>>& pages) { EXPECT_TRUE(pages); });
    EXPECT_GE(call_count, 3);
  }
}

TEST_F(ReadFaults, AFileCutShortAfterOpeningIsTruncated) {
  const Result<PageFile> file = PageFile::open(path_);
  ASSERT_TRUE(file);
  const PageEntry last = *file->entry(2);
  std::filesystem::resize_file(path_, last.offset + 1);
  EXPECT_TRUE(read_page(*file, 1));
  const Result<Bytes> raw = read_page(*file, 2);
  ASSERT_FALSE(raw);
  EXPECT_EQ(raw.error().code, ErrorCode::kTruncated);
  EXPECT_EQ(raw.error().page, 2u);
  EXPECT_EQ(raw.error().offset, last.offset);
}

TEST_F(ReadFaults, MappingCoversAnyRange) {
  const Bytes whole = read_bytes(path_);
  const FileHandle file = FileHandle::open(FileCalls::real(), AT_FDCWD, path_.c_str(), O_RDONLY);
  ASSERT_TRUE(file.is_open());
  for (const std::size_t offset : {std::size_t{0}, std::size_t{1}, whole.size() - 1}) {
    Result<Mapping> made = Mapping::create(file, offset, whole.size() - offset);
    ASSERT_TRUE(made);
    Mapping moved_mapping = *std::move(made);
    ASSERT_EQ(moved_mapping.bytes().size(), whole.size() - offset);
    EXPECT_TRUE(std::equal(moved_mapping.bytes().begin(), moved_mapping.bytes().end(),
                           whole.begin() + static_cast<std::ptrdiff_t>(offset)));
    EXPECT_TRUE(made->bytes().empty());
  }
  // A short range that crosses a border of system pages.
  std::filesystem::resize_file(path_, 1 << 20);
  const Result<Mapping> across = Mapping::create(file, 65536 - 10, 20);
  ASSERT_TRUE(across);
  EXPECT_EQ(across->bytes()[19], std::byte{0});
  EXPECT_FALSE(Mapping::create(file, 1, SIZE_MAX));
  EXPECT_FALSE(Mapping::create(file, std::uint64_t{1} << 63, 1));
}

}  // namespace
}  // namespace planetree::storage
