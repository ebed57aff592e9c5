#include "storage/file/directory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

constexpr std::uint32_t kFanOut = DirectoryShape::kFanOut;

// A page of a few bytes, different from those of its neighbours.
Bytes small_page(std::uint32_t page) {
  Bytes raw(1 + page % 5);
  for (std::size_t i = 0; i < raw.size(); ++i) raw[i] = static_cast<std::byte>(page >> 8 * (i % 4));
  return raw;
}

// Files with many small pages.
class ManyPages : public testing::Test {
 protected:
  void write(std::uint32_t page_count) {
    Result<PageWriter> writer = PageWriter::create(path_, page_count, {}, true);
    ASSERT_TRUE(writer);
    for (std::uint32_t page = 0; page < page_count; ++page) {
      const Bytes raw = small_page(page);
      const auto bytes = static_cast<std::uint32_t>(raw.size());
      ASSERT_TRUE(writer->append(page / 3, bytes, compress_page(raw)));
    }
    const Result<FileHeader> header = writer->finish(sample_model(), kMinPageBytes);
    ASSERT_TRUE(header);
    shape_ = DirectoryShape(page_count);
  }
  PageFile open() const {
    Result<PageFile> file = PageFile::open(path_);
    EXPECT_TRUE(file);
    return *std::move(file);
  }
  void change_block(unsigned level, std::uint64_t block, std::size_t at) const {
    Bytes bytes = read_bytes(path_);
    bytes[kHeaderBytes + shape_.block_offset(level, block) + at] ^= std::byte{1};
    write_bytes(path_, bytes);
  }
  static void expect_page(const PageFile& file, std::uint32_t page) {
    const Result<Bytes> raw = read_page(file, page);
    ASSERT_TRUE(raw) << raw.error().text;
    ASSERT_EQ(*raw, small_page(page)) << page;
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "a.ptree";
  DirectoryShape shape_{1};
};

TEST_F(ManyPages, AreFoundAroundTheBordersOfBlocks) {
  for (const std::uint32_t count : {1u, kFanOut - 1, kFanOut, kFanOut + 1, 2 * kFanOut, 1300u}) {
    write(count);
    EXPECT_EQ(shape_.levels(), count <= kFanOut ? 1u : 2u);
    const PageFile file = open();
    EXPECT_EQ(file.page_count(), count);
    for (std::uint32_t page = 0; page < count; ++page) {
      ASSERT_TRUE(file.kept_entry(page));
      EXPECT_EQ(file.entry(page)->octcode, page / 3);
      expect_page(file, page);
    }
  }
}

TEST_F(ManyPages, OfALargeFileAreReadWhenNeeded) {
  constexpr std::uint32_t kCount = kFanOut * kFanOut + 700;
  write(kCount);
  ASSERT_EQ(shape_.levels(), 3u);
  ASSERT_GT(shape_.blocks(), Directory::kMaxBlocks);
  const PageFile file = open();
  EXPECT_EQ(file.directory_memory_bytes(), Directory::kMaxBlocks * DirectoryShape::kBlockBytes);
  EXPECT_FALSE(file.kept_entry(kCount - 1));
  Bytes scratch(file.header().max_stored_bytes), raw(file.header().max_raw_bytes);
  EXPECT_FALSE(*file.try_read_page(kCount - 1, scratch, raw));
  expect_page(file, kCount - 1);
  EXPECT_TRUE(file.kept_entry(kCount - 1));
  // More blocks than are kept, twice: the first ones are gone when they are needed again.
  for (int round = 0; round < 2; ++round)
    for (std::uint32_t page = 0; page < kCount; page += kFanOut - 1) expect_page(file, page);
  EXPECT_FALSE(file.kept_entry(0));
  EXPECT_EQ(file.entry(kCount).error().code, ErrorCode::kBadArgument);
}

TEST_F(ManyPages, OfALargeFileAreFoundByManyThreads) {
  constexpr std::uint32_t kCount = kFanOut * kFanOut + 1;
  write(kCount);
  const PageFile file = open();
  std::atomic<int> wrong{0};
  std::vector<std::thread> threads;
  for (std::uint32_t seed = 0; seed < 4; ++seed)
    threads.emplace_back([&, seed] {
      for (std::uint32_t i = 0; i < 3000; ++i) {
        const std::uint32_t page = (i * 2654435761u + seed * 977u) % kCount;
        const Result<Bytes> raw = read_page(file, page);
        wrong += !raw || *raw != small_page(page);
      }
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(wrong, 0);
}

TEST_F(ManyPages, BelowADamagedBlockAreLostAndNoOthers) {
  constexpr std::uint32_t kCount = kFanOut * kFanOut + 700;
  write(kCount);
  change_block(shape_.page_level(), 7, 16);
  const PageFile file = open();
  for (const std::uint32_t page : {7 * kFanOut - 1, 8 * kFanOut, kCount - 1})
    expect_page(file, page);
  for (const std::uint32_t page : {7 * kFanOut, 8 * kFanOut - 1}) {
    const Result<Bytes> raw = read_page(file, page);
    ASSERT_FALSE(raw);
    EXPECT_EQ(raw.error().code, ErrorCode::kDamaged);
  }
}

TEST_F(ManyPages, AreRefusedAtOpenWhereAllBlocksAreKept) {
  write(kFanOut + 5);
  for (const unsigned level : {0u, 1u}) {
    change_block(level, 0, 3);
    const Result<PageFile> file = PageFile::open(path_);
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, ErrorCode::kDamaged);
    change_block(level, 0, 3);
  }
  EXPECT_TRUE(PageFile::open(path_));
}

// What a block states must follow from the block below it, even if all hashes are right.
TEST_F(ManyPages, AreRefusedWhereTwoBlocksDisagree) {
  write(kFanOut + 5);
  const auto code_with = [this](auto change) {
    FileImage image(read_bytes(path_));
    DirectoryBlock block;
    const std::size_t at = kHeaderBytes + kDirectoryEntryBytes;
    std::memcpy(&block, image.bytes().data() + at, sizeof block);
    change(block);
    std::memcpy(image.bytes().data() + at, &block, sizeof block);
    const Hash128 id = hash128(std::span(image.bytes()).subspan(kHeaderBytes, 2 * sizeof block));
    image.change_header([&id](FileHeader& header) {
      header.content_id[0] = id.low;
      header.content_id[1] = id.high;
    });
    image.seal_header();
    write_bytes(directory_ / "changed", image.bytes());
    const Result<PageFile> file = PageFile::open(directory_ / "changed");
    return file ? ErrorCode{} : file.error().code;
  };
  EXPECT_EQ(code_with([](DirectoryBlock&) {}), ErrorCode{});
  EXPECT_EQ(code_with([](DirectoryBlock& block) { ++block.octcode; }), ErrorCode::kDamaged);
  EXPECT_EQ(code_with([](DirectoryBlock& block) { ++block.offset; }), ErrorCode::kDamaged);
  EXPECT_EQ(code_with([](DirectoryBlock& block) { block.offset = ~std::uint64_t{0}; }),
            ErrorCode::kDamaged);
  EXPECT_EQ(code_with([](DirectoryBlock& block) { ++block.check; }), ErrorCode::kDamaged);
}

}  // namespace
}  // namespace planetree::storage
