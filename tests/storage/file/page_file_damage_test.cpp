#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>

#include "storage/file/page_file.h"
#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/temporary_directory.h"

/// Files damaged in the ways of disks and people.
namespace planetree::storage {
namespace {

class PageFileDamage : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(sample_.write(path_));
    good_ = read_bytes(path_);
  }

  void set_byte(std::size_t offset, std::byte byte) const {
    const int file = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
    EXPECT_EQ(::pwrite(file, &byte, 1, static_cast<off_t>(offset)), 1);
    ::close(file);
  }

  // Whether every page reads as it was written, even if one of the headers is damaged.
  bool serves_all() const {
    const Result<std::vector<Bytes>> pages = read_all(path_);
    if (!pages || pages->size() != sample_.page_count) return false;
    for (std::uint32_t page = 0; page < sample_.page_count; ++page) {
      if ((*pages)[page] != sample_.raw(page)) return false;
    }
    return true;
  }

  SampleFile sample_;
  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "a.ptree";
  Bytes good_;
};

TEST_F(PageFileDamage, DetectsEveryFlippedBit) {
  const std::size_t first_page = pages_start(FileImage(good_).header());
  const std::size_t pages_end = good_.size() - kHeaderBytes;
  for (std::size_t bit = 0; bit < good_.size() * 8; ++bit) {
    const std::size_t at = bit / 8;
    set_byte(at, good_[at] ^ static_cast<std::byte>(1u << bit % 8));
    const Result<PageFile> file = PageFile::open(path_);
    if (at < kHeaderBytes || at >= pages_end) {
      ASSERT_TRUE(file) << bit << file.error().text;
      ASSERT_TRUE(file->header_copy_damaged()) << bit;
      ASSERT_TRUE(serves_all()) << bit;
    } else if (at < first_page) {
      ASSERT_FALSE(file) << bit;
      ASSERT_EQ(file.error().code, ErrorCode::kDamaged) << bit;
    } else {
      ASSERT_TRUE(file) << bit;
      for (std::uint32_t page = 0; page < sample_.page_count; ++page) {
        const PageEntry entry = *file->entry(page);
        const bool hit = at >= entry.offset && at < entry.offset + entry.stored_bytes;
        const Result<Bytes> raw = read_page(*file, page);
        ASSERT_EQ(bool(raw), !hit) << bit;
        if (!hit) continue;
        ASSERT_EQ(raw.error().code, ErrorCode::kDamaged) << bit;
        ASSERT_EQ(raw.error().page, page) << bit;
        ASSERT_EQ(raw.error().offset, entry.offset) << bit;
      }
    }
    set_byte(at, good_[at]);
  }
  EXPECT_TRUE(serves_all());
}

TEST_F(PageFileDamage, RefusesEveryOtherLength) {
  for (std::size_t length = good_.size(); length-- > 0;) {
    std::filesystem::resize_file(path_, length);
    const Result<PageFile> file = PageFile::open(path_);
    ASSERT_FALSE(file) << length;
    ASSERT_EQ(file.error().code, length == 0 ? ErrorCode::kNotPlanetree : ErrorCode::kTruncated);
    const std::string found = "has " + std::to_string(length);
    ASSERT_TRUE(length == 0 || std::strstr(file.error().text, found.c_str())) << file.error().text;
  }
  for (const std::size_t extra : {1u, 512u, 5000u}) {
    Bytes longer = good_;
    longer.resize(good_.size() + extra);
    write_bytes(path_, longer);
    const Result<PageFile> file = PageFile::open(path_);
    ASSERT_FALSE(file) << extra;
    ASSERT_EQ(file.error().code, ErrorCode::kTruncated) << extra;
  }
}

TEST_F(PageFileDamage, OpensWithEitherHeader) {
  for (const std::size_t start : {std::size_t{0}, good_.size() - kHeaderBytes}) {
    Bytes bytes = good_;
    std::fill_n(bytes.begin() + static_cast<std::ptrdiff_t>(start), kHeaderBytes, std::byte{0});
    write_bytes(path_, bytes);
    const Result<PageFile> file = PageFile::open(path_);
    ASSERT_TRUE(file) << file.error().text;
    EXPECT_TRUE(file->header_copy_damaged());
    EXPECT_TRUE(serves_all());
  }
}

TEST_F(PageFileDamage, HeadersThatDifferAreReported) {
  Bytes bytes = good_;
  FileImage other(good_);
  other.change_header([](FileHeader& header) { header.compatible_features = 1; });
  other.seal_header();
  std::copy_n(other.bytes().begin(), kHeaderBytes, bytes.begin());
  write_bytes(path_, bytes);
  const Result<PageFile> file = PageFile::open(path_);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->header_copy_damaged());
  EXPECT_EQ(file->header().compatible_features, 1u);
}

TEST(PageFileMixUp, SwappedPagesFail) {
  const TemporaryDirectory directory;
  // Pages 1 and 3 are stored uncompressed. The swap exchanges bytes and keeps the lengths.
  const SampleFile sample{4, 500};
  ASSERT_TRUE(sample.write(directory / "a.ptree"));
  FileImage image(read_bytes(directory / "a.ptree"));
  const Bytes first(image.stored(1).begin(), image.stored(1).end());
  std::copy_n(image.stored(3).begin(), first.size(), image.stored(1).begin());
  std::copy(first.begin(), first.end(), image.stored(3).begin());
  write_bytes(directory / "b.ptree", image.bytes());
  const Result<PageFile> file = PageFile::open(directory / "b.ptree");
  ASSERT_TRUE(file);
  EXPECT_TRUE(read_page(*file, 0));
  EXPECT_FALSE(read_page(*file, 1));
  EXPECT_TRUE(read_page(*file, 2));
  EXPECT_FALSE(read_page(*file, 3));
}

// A page with the same number and offset, but of another file.
TEST(PageFileMixUp, PagesOfAnotherFileFail) {
  const TemporaryDirectory directory;
  ASSERT_TRUE((SampleFile{2, 500, 1}.write(directory / "a.ptree")));
  ASSERT_TRUE((SampleFile{2, 500, 2}.write(directory / "b.ptree")));
  FileImage image(read_bytes(directory / "a.ptree"));
  FileImage other(read_bytes(directory / "b.ptree"));
  ASSERT_EQ(image.entry(1).raw_bytes, other.entry(1).raw_bytes);
  ASSERT_EQ(image.entry(1).stored_bytes, image.entry(1).raw_bytes);
  std::copy_n(other.stored(1).begin(), image.entry(1).stored_bytes, image.stored(1).begin());
  write_bytes(directory / "c.ptree", image.bytes());
  const Result<PageFile> file = PageFile::open(directory / "c.ptree");
  ASSERT_TRUE(file);
  EXPECT_FALSE(read_page(*file, 1));
  // The hash in the other file's directory does not make it valid either.
  image.change_entry(1, [&](DirectoryPage& entry) { entry.check = other.entry(1).check; });
  write_bytes(directory / "c.ptree", image.bytes());
  EXPECT_FALSE(PageFile::open(directory / "c.ptree"));
}

TEST(PageFileMixUp, RefusesBadLz4BlocksWithRightHashes) {
  const TemporaryDirectory directory;
  ASSERT_TRUE((SampleFile{1, 4000}.write(directory / "a.ptree")));
  FileImage image(read_bytes(directory / "a.ptree"));
  ASSERT_LT(image.entry(0).stored_bytes, image.entry(0).raw_bytes);
  std::fill(image.stored(0).begin(), image.stored(0).end(), std::byte{0xff});
  image.seal();
  write_bytes(directory / "b.ptree", image.bytes());
  const Result<PageFile> file = PageFile::open(directory / "b.ptree");
  ASSERT_TRUE(file);
  const Result<Bytes> raw = read_page(*file, 0);
  ASSERT_FALSE(raw);
  EXPECT_EQ(raw.error().code, ErrorCode::kDamaged);
  EXPECT_NE(std::strstr(raw.error().text, "LZ4"), nullptr);
  EXPECT_EQ(raw.error().page, 0u);
}

}  // namespace
}  // namespace planetree::storage
