// Directories of files with 10^10 and 10^11 triangles. The files have holes, except for the parts
// that the tests read.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

constexpr std::uint64_t kPageTriangles = 1700;  // of a large file with pages of 64 KiB
constexpr std::uint32_t kPageBytes = 16384;     // stored, the same for all pages

class CountingCalls : public FileCalls {
 public:
  std::uint64_t reads = 0, bytes_read = 0;
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    const ssize_t done = FileCalls::pread(descriptor, out, bytes, offset);
    ++reads;
    if (done > 0) bytes_read += static_cast<std::uint64_t>(done);
    return done;
  }
};

// Writes the header, one page, and the blocks of the directory that lead to it.
class SparseFile {
 public:
  SparseFile(std::filesystem::path path, std::uint64_t triangles, std::uint32_t page)
      : path_(std::move(path)), shape_(1), page_(page) {
    header_.page_count = static_cast<std::uint32_t>(triangles / kPageTriangles);
    shape_ = DirectoryShape(header_.page_count);
    describe(triangles);
    const std::uint64_t directory = directory_start(0);
    std::ofstream(path_, std::ios::binary);
    std::filesystem::resize_file(path_, header_.file_bytes);
    write(pages_start(header_) + std::uint64_t{page_} * kPageBytes, page_bytes());
    // From the block of pages up: each block has the hash of the one below it.
    Bytes below = page_block();
    write(directory + shape_.block_offset(shape_.page_level(), block_at(shape_.page_level())),
          below);
    for (unsigned level = shape_.page_level(); level-- > 0;) {
      Bytes block = upper_block(level, hash64(below));
      write(directory + shape_.block_offset(level, block_at(level)), block);
      below = std::move(block);
    }
    const Hash128 id = hash128(below);
    header_.content_id[0] = id.low;
    header_.content_id[1] = id.high;
    header_.header_hash = header_hash(header_);
    write(0, bytes_of(header_));
    write(header_.file_bytes - kHeaderBytes, bytes_of(header_));
  }

  const DirectoryShape& shape() const { return shape_; }
  Bytes page_bytes() const { return sample_page(page_, kPageBytes, 3); }

 private:
  template <class T>
  static Bytes bytes_of(const T& value) {
    const auto bytes = std::as_bytes(std::span(&value, 1));
    return {bytes.begin(), bytes.end()};
  }
  void describe(std::uint64_t triangles) {
    std::memcpy(header_.magic, kMagic, sizeof kMagic);
    header_.version = kFormatVersion;
    header_.header_bytes = kHeaderBytes;
    header_.page_bytes = 65536;
    header_.extensions_hash = hash64({});
    header_.max_raw_bytes = kPageBytes;
    header_.max_stored_bytes = kPageBytes;
    header_.model = sample_model();
    header_.model.triangle_count = triangles;
    header_.model.triangle_id_bytes = 8;
    header_.stored_bytes[0] = std::uint64_t{header_.page_count} * kPageBytes;
    header_.file_bytes = pages_end(header_) + kHeaderBytes;
  }
  std::uint64_t block_at(unsigned level) const { return shape_.block_of_page(level, page_); }

  Bytes page_block() const {
    const std::uint64_t block = block_at(shape_.page_level());
    std::vector<DirectoryPage> entries(shape_.block_entries(shape_.page_level(), block));
    for (DirectoryPage& entry : entries) entry = {1, 0, kPageBytes, kPageBytes};
    entries[page_ % DirectoryShape::kFanOut].check = hash64(page_bytes());
    const auto bytes = std::as_bytes(std::span(entries));
    return {bytes.begin(), bytes.end()};
  }
  Bytes upper_block(unsigned level, std::uint64_t check) const {
    std::uint64_t pages_below = DirectoryShape::kFanOut;
    for (unsigned below = level + 1; below < shape_.page_level(); ++below)
      pages_below *= DirectoryShape::kFanOut;
    std::vector<DirectoryBlock> entries(shape_.block_entries(level, block_at(level)));
    const std::uint64_t first = block_at(level) * DirectoryShape::kFanOut;
    for (std::size_t i = 0; i < entries.size(); ++i)
      entries[i] = {1, 0, (first + i) * pages_below * kPageBytes};
    entries[block_at(level + 1) % DirectoryShape::kFanOut].check = check;
    const auto bytes = std::as_bytes(std::span(entries));
    return {bytes.begin(), bytes.end()};
  }
  void write(std::uint64_t offset, const Bytes& bytes) const {
    std::fstream file(path_, std::ios::in | std::ios::out | std::ios::binary);
    file.seekp(static_cast<std::streamoff>(offset));
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }

  std::filesystem::path path_;
  FileHeader header_{};
  DirectoryShape shape_;
  std::uint32_t page_;
};

class SparseDirectory : public testing::TestWithParam<std::uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Triangles, SparseDirectory,
                         testing::Values(10'000'000'000, 100'000'000'000));

TEST_P(SparseDirectory, OpensByItsRootAndFindsAPageByItsBlocks) {
  const TemporaryDirectory directory;
  const auto page = static_cast<std::uint32_t>(GetParam() / kPageTriangles / 3);
  const SparseFile sparse(directory / "a.ptree", GetParam(), page);
  EXPECT_EQ(sparse.shape().levels(), 3u);
  CountingCalls calls;
  const Result<PageFile> file = PageFile::open(directory / "a.ptree", calls);
  ASSERT_TRUE(file) << file.error().text;
  EXPECT_LE(calls.bytes_read, 16u << 10);
  EXPECT_LE(calls.reads, 4u);
  EXPECT_LE(file->directory_memory_bytes(), 3u << 20);
  const Result<Bytes> raw = read_page(*file, page);
  ASSERT_TRUE(raw) << raw.error().text;
  EXPECT_EQ(*raw, sparse.page_bytes());
  EXPECT_LE(calls.bytes_read, (16u << 10) + 2 * DirectoryShape::kBlockBytes + kPageBytes);
  // Neighbours have the same blocks; they are holes, and so damaged.
  const Result<Bytes> neighbour = read_page(*file, page + 1);
  ASSERT_FALSE(neighbour);
  EXPECT_EQ(neighbour.error().code, ErrorCode::kDamaged);
  const Result<Bytes> far = read_page(*file, 5);
  ASSERT_FALSE(far);
  EXPECT_EQ(far.error().code, ErrorCode::kDamaged);
}

}  // namespace
}  // namespace planetree::storage
