#include "storage/spill/spill_buckets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

constexpr std::size_t kRecordBytes = 12;

/// Writes a record that holds its own number and bucket.
void put(std::byte* to, std::uint64_t number, std::uint32_t bucket) {
  std::memcpy(to, &number, sizeof number);
  std::memcpy(to + sizeof number, &bucket, sizeof bucket);
}

/// Numbers of a bucket's records, sorted.
std::vector<std::uint64_t> numbers_in(SpillBuckets& buckets, std::uint32_t bucket) {
  std::vector<std::uint64_t> numbers;
  const auto read = buckets.each_block(bucket, [&](std::span<const std::byte> records) {
    EXPECT_EQ(records.size() % kRecordBytes, 0u);
    for (; !records.empty(); records = records.subspan(kRecordBytes)) {
      std::uint32_t found = 0;
      std::memcpy(&numbers.emplace_back(), records.data(), sizeof(std::uint64_t));
      std::memcpy(&found, records.data() + sizeof(std::uint64_t), sizeof found);
      EXPECT_EQ(found, bucket);
    }
    return Result<void>();
  });
  EXPECT_TRUE(read);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

TEST(SpillBuckets, ReturnTheRecordsOfEachBucket) {
  const TemporaryDirectory directory;
  for (const std::uint64_t buffer_bytes : {0, 3000, 1 << 20}) {
    SpillFile file(directory / ".", 0);
    SpillBuckets buckets(kRecordBytes, 7, buffer_bytes, file);
    std::vector<std::vector<std::uint64_t>> expected(7);
    std::mt19937 random(1);
    for (std::uint64_t i = 0; i < 5000; ++i) {
      // Unevenly distributed, with no record in the last bucket.
      const auto bucket = static_cast<std::uint32_t>(std::min(random() % 6, random() % 6));
      std::byte* const record = buckets.add(bucket);
      ASSERT_NE(record, nullptr);
      put(record, i, bucket);
      expected[bucket].push_back(i);
    }
    for (std::uint32_t bucket = 0; bucket < 7; ++bucket)
      for (int again = 0; again < 2; ++again)
        EXPECT_EQ(numbers_in(buckets, bucket), expected[bucket]);
    EXPECT_FALSE(buckets.is_empty(0));
    EXPECT_TRUE(buckets.is_empty(6));
    EXPECT_EQ(file.size_bytes() == 0, buffer_bytes == 1 << 20);
    // Each block has 8 bytes besides its records.
    EXPECT_LE(file.size_bytes(), 5000 * kRecordBytes * 1.1);
  }
}

TEST(SpillBuckets, ReportFailuresOfTheFile) {
  const TemporaryDirectory directory;
  FaultyCalls calls;
  SpillFile file(directory / ".", 0, calls);
  SpillBuckets buckets(kRecordBytes, 2, 0, file);
  for (std::uint64_t i = 0; i < 100; ++i) put(buckets.add(1), i, 1);
  calls.fault = FaultyCalls::Fault::kError;
  calls.every = true;
  const auto read =
      buckets.each_block(1, [](std::span<const std::byte>) { return Result<void>(); });
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().code, ErrorCode::kReadFailed);
  calls.number = ENOSPC;
  while (std::byte* const record = buckets.add(0)) put(record, 0, 0);
  EXPECT_EQ(buckets.failure().code, ErrorCode::kNoSpace);
}

}  // namespace
}  // namespace planetree::storage
