#include "storage/spill/result_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "storage/spill/spill_file.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

constexpr std::uint64_t kKind = 17;

class ResultFileTest : public testing::Test {
 protected:
  static std::vector<std::byte> random_bytes(std::size_t count) {
    std::mt19937 random(static_cast<unsigned>(count));
    std::vector<std::byte> bytes(count);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
    return bytes;
  }
  Result<Hash128> write(const std::vector<std::byte>& data, bool replace = true,
                        FileCalls& calls = FileCalls::real()) {
    auto file = NewResultFile::create(path_, replace, calls);
    if (!file) return file.error();
    SpillFile spill(file->file());
    // Two halves, to see that appended bytes come one after the other.
    const std::size_t half = data.size() / 2;
    for (const auto part : {std::span(data).first(half), std::span(data).subspan(half)})
      if (const auto offset = spill.append(part); !offset) return offset.error();
    return file->finish(kKind, spill.size_bytes(), record_);
  }

  TemporaryDirectory folder_;
  const std::filesystem::path path_ = folder_ / "result";
  const std::vector<std::byte> record_ = random_bytes(77);
};

TEST_F(ResultFileTest, GivesBackDataAndRecord) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{1}, ResultFile::kBlockBytes - 1,
                                 ResultFile::kBlockBytes, 3 * ResultFile::kBlockBytes + 5}) {
    const auto data = random_bytes(size);
    const auto id = write(data);
    ASSERT_TRUE(id) << id.error().text;
    const auto file = ResultFile::open(path_, kKind);
    ASSERT_TRUE(file) << file.error().text;
    EXPECT_EQ(file->id(), *id);
    EXPECT_EQ(file->data_bytes(), size);
    EXPECT_TRUE(std::ranges::equal(file->record(), record_));
    std::mt19937 random(1);
    for (int i = 0; i < 200; ++i) {
      const std::size_t from = random() % (size + 1), count = random() % (size - from + 1);
      std::vector<std::byte> found(count);
      ASSERT_TRUE(file->read(from, found));
      EXPECT_TRUE(std::equal(found.begin(), found.end(), data.begin() + static_cast<long>(from)));
    }
  }
}

TEST_F(ResultFileTest, HasAnIdOfItsContent) {
  auto data = random_bytes(100);
  const auto first = write(data), again = write(data);
  EXPECT_EQ(*first, *again);
  data[3] ^= std::byte{1};
  EXPECT_NE(*first, *write(data));
}

TEST_F(ResultFileTest, FindsAnyChangedByte) {
  const auto data = random_bytes(ResultFile::kBlockBytes + 900);
  ASSERT_TRUE(write(data));
  const auto bytes = read_bytes(path_);
  for (std::size_t at = 0; at < bytes.size(); at += at < data.size() ? 997 : 1) {
    auto changed = bytes;
    changed[at] ^= std::byte{0x40};
    write_bytes(path_, changed);
    const auto file = ResultFile::open(path_, kKind);
    if (at >= data.size()) {
      EXPECT_FALSE(file) << at;
      continue;
    }
    ASSERT_TRUE(file);
    std::vector<std::byte> found(data.size());
    const auto read = file->read(0, found);
    ASSERT_FALSE(read) << at;
    EXPECT_EQ(read.error().code, ErrorCode::kDamaged);
    EXPECT_EQ(read.error().offset, at / ResultFile::kBlockBytes * ResultFile::kBlockBytes);
    EXPECT_NE(std::string(read.error().text).find("result does not have"), std::string::npos);
    // The block that was not changed can be read.
    const std::size_t whole = at < ResultFile::kBlockBytes ? ResultFile::kBlockBytes : 0;
    EXPECT_TRUE(file->read(whole, std::span(found).first(1)));
  }
}

TEST_F(ResultFileTest, RefusesAnyTruncatedFile) {
  ASSERT_TRUE(write(random_bytes(300)));
  const auto bytes = read_bytes(path_);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    write_bytes(path_, {bytes.begin(), bytes.begin() + static_cast<long>(size)});
    EXPECT_FALSE(ResultFile::open(path_, kKind)) << size;
  }
}

TEST_F(ResultFileTest, RefusesAnotherKindAndOtherFiles) {
  ASSERT_TRUE(write(random_bytes(300)));
  EXPECT_EQ(ResultFile::open(path_, kKind + 1).error().code, ErrorCode::kBadInput);
  EXPECT_EQ(ResultFile::open(folder_ / "none", kKind).error().code, ErrorCode::kNotFound);
  write_bytes(path_, random_bytes(5000));
  EXPECT_EQ(ResultFile::open(path_, kKind).error().code, ErrorCode::kBadInput);
}

TEST_F(ResultFileTest, ReplacesAnEarlierFileOnlyIfTold) {
  ASSERT_TRUE(write(random_bytes(10)));
  const auto bytes = read_bytes(path_);
  EXPECT_EQ(write(random_bytes(20), false).error().code, ErrorCode::kAlreadyExists);
  EXPECT_EQ(read_bytes(path_), bytes);
  EXPECT_TRUE(write(random_bytes(20), true));
  EXPECT_NE(read_bytes(path_), bytes);
}

TEST_F(ResultFileTest, AppearsCompleteOrNotAtAll) {
  const auto data = random_bytes(ResultFile::kBlockBytes + 10);
  for (int call = 0;; ++call) {
    FaultyCalls calls;
    calls.fault = FaultyCalls::Fault::kError;
    calls.fault_at = call;
    const auto written = write(data, false, calls);
    if (!calls.happened()) break;
    const bool exists = std::filesystem::exists(path_);
    EXPECT_EQ(exists, ResultFile::open(path_, kKind).operator bool()) << call;
    EXPECT_TRUE(exists || !written) << call;
    std::filesystem::remove(path_);
  }
}

TEST_F(ResultFileTest, IsReadThroughTheFileItIsAttachedTo) {
  const auto data = random_bytes(5000);
  ASSERT_TRUE(write(data));
  auto file = ResultFile::open(path_, kKind);
  ASSERT_TRUE(file);
  SpillFile spill(folder_ / ".", 0);
  const auto shared = std::make_shared<const ResultFile>(*std::move(file));
  const std::uint64_t first = spill.attach(shared), second = spill.attach(shared);
  const auto own = random_bytes(300);
  const auto at = spill.append(own);
  ASSERT_TRUE(at);
  std::vector<std::byte> found(300);
  for (const std::uint64_t offset : {first, second}) {
    ASSERT_TRUE(spill.read(offset + 1234, found));
    EXPECT_TRUE(std::equal(found.begin(), found.end(), data.begin() + 1234));
  }
  ASSERT_TRUE(spill.read(*at, found));
  EXPECT_EQ(found, own);
  EXPECT_EQ(spill.size_bytes(), 300u);
}

}  // namespace
}  // namespace planetree::storage
