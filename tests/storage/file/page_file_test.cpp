#include "storage/file/page_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <atomic>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <thread>

#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/temporary_directory.h"

namespace {
thread_local std::size_t allocation_count = 0;
}  // namespace

// Counted for the whole test program; every other form of new calls this one. Weak, because some
// sanitizers bring their own.
[[gnu::weak]] void* operator new(std::size_t bytes) {
  ++allocation_count;
  if (void* const memory = std::malloc(bytes == 0 ? 1 : bytes)) return memory;
  throw std::bad_alloc();
}
[[gnu::weak]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::weak]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

namespace planetree::storage {
namespace {

TEST(PageFile, ReadsWhatWasWritten) {
  const TemporaryDirectory directory;
  for (const std::uint32_t page_count : {1u, 2u, 40u}) {
    const SampleFile sample{page_count, 10'000};
    const Result<FileHeader> header = sample.write(directory / "a.ptree", true);
    ASSERT_TRUE(header);
    const Result<PageFile> file = PageFile::open(directory / "a.ptree");
    ASSERT_TRUE(file) << file.error().text;
    EXPECT_EQ(std::memcmp(&file->header(), &*header, sizeof(FileHeader)), 0);
    EXPECT_FALSE(file->header_copy_damaged());
    EXPECT_EQ(file->page_count(), page_count);
    EXPECT_EQ(file->directory_memory_bytes(), page_count * kDirectoryEntryBytes);
    for (std::uint32_t page = 0; page < page_count; ++page) {
      const Result<Bytes> raw = read_page(*file, page);
      ASSERT_TRUE(raw) << raw.error().text;
      EXPECT_EQ(*raw, sample.raw(page));
    }
  }
}

TEST(PageFile, HoldsPagesOfBothCodecs) {
  const TemporaryDirectory directory;
  ASSERT_TRUE(SampleFile().write(directory / "a.ptree"));
  const Result<PageFile> file = PageFile::open(directory / "a.ptree");
  ASSERT_TRUE(file);
  EXPECT_EQ(file->entry(0)->codec(), Codec::kLz4);
  EXPECT_EQ(file->entry(1)->codec(), Codec::kStored);
  EXPECT_EQ(file->entry(2)->octcode, 1u);
}

TEST(PageFile, ReadsWithoutAllocating) {
  const TemporaryDirectory directory;
  const SampleFile sample{4, 70'000};
  ASSERT_TRUE(sample.write(directory / "a.ptree"));
  const Result<PageFile> file = PageFile::open(directory / "a.ptree");
  ASSERT_TRUE(file);
  Bytes scratch(file->header().max_stored_bytes);
  Bytes raw(file->header().max_raw_bytes);
  const std::size_t before = allocation_count;
  for (std::uint32_t page = 0; page < 4; ++page) {
    const bool read =
        bool(file->read_page(page, scratch, std::span(raw).first(file->entry(page)->raw_bytes)));
    EXPECT_TRUE(read);
  }
  EXPECT_EQ(allocation_count, before);
  ::operator delete(::operator new(1));
  if (allocation_count != before + 1) GTEST_SKIP() << "a sanitizer keeps allocations to itself";
}

TEST(PageFile, ReadsFromSeveralThreadsAtOnce) {
  const TemporaryDirectory directory;
  const SampleFile sample{16, 5000};
  ASSERT_TRUE(sample.write(directory / "a.ptree"));
  const Result<PageFile> file = PageFile::open(directory / "a.ptree");
  ASSERT_TRUE(file);
  std::atomic<int> right{0};
  const auto read_some = [&] {
    for (std::uint32_t i = 0; i < 64; ++i) {
      const Result<Bytes> raw = read_page(*file, i % 16);
      right += raw && *raw == sample.raw(i % 16) ? 1 : 0;
    }
  };
  std::thread first(read_some);
  std::thread second(read_some);
  first.join();
  second.join();
  EXPECT_EQ(right, 128);
}

TEST(PageFile, KeepsReadingTheOpenedFileAfterItIsReplaced) {
  const TemporaryDirectory directory;
  const SampleFile old{3, 120, 1};
  ASSERT_TRUE(old.write(directory / "a.ptree"));
  const Result<PageFile> file = PageFile::open(directory / "a.ptree");
  ASSERT_TRUE(file);
  ASSERT_TRUE((SampleFile{5, 333, 2}.write(directory / "a.ptree", true)));
  for (std::uint32_t page = 0; page < 3; ++page) {
    const Result<Bytes> raw = read_page(*file, page);
    ASSERT_TRUE(raw);
    EXPECT_EQ(*raw, old.raw(page));
  }
  EXPECT_EQ(read_all(directory / "a.ptree")->size(), 5u);
}

TEST(PageFile, RefusesWrongArguments) {
  const TemporaryDirectory directory;
  ASSERT_TRUE(SampleFile().write(directory / "a.ptree"));
  const Result<PageFile> file = PageFile::open(directory / "a.ptree");
  ASSERT_TRUE(file);
  const auto refused = [&](std::uint32_t page, std::size_t scratch_bytes, std::size_t raw_bytes) {
    Bytes scratch(scratch_bytes);
    Bytes raw(raw_bytes);
    const Result<void> read = file->read_page(page, scratch, raw);
    return !read && read.error().code == ErrorCode::kBadArgument && read.error().page == page;
  };
  const std::size_t scratch_bytes = file->header().max_stored_bytes;
  EXPECT_FALSE(refused(0, scratch_bytes, 120));
  EXPECT_TRUE(refused(3, scratch_bytes, 120));
  EXPECT_TRUE(refused(~0u, scratch_bytes, 120));
  EXPECT_TRUE(refused(0, scratch_bytes - 1, 120));
  EXPECT_TRUE(refused(0, scratch_bytes, 119));
  EXPECT_TRUE(refused(0, scratch_bytes, 121));
}

TEST(PageFile, OpensThroughASymbolicLink) {
  const TemporaryDirectory directory;
  ASSERT_TRUE(SampleFile().write(directory / "a.ptree"));
  std::filesystem::create_symlink("a.ptree", directory / "link");
  EXPECT_TRUE(PageFile::open(directory / "link"));
}

TEST(PageFile, ErrorNamesWhatIsFoundInstead) {
  const TemporaryDirectory directory;
  const auto open = [&](const char* name) {
    const Result<PageFile> file = PageFile::open(directory / name);
    EXPECT_FALSE(file) << name;
    return file ? Error{} : file.error();
  };
  EXPECT_EQ(open("nothing").code, ErrorCode::kNotFound);

  std::filesystem::create_directory(directory / "folder");
  EXPECT_EQ(open("folder").code, ErrorCode::kNotPlanetree);
  EXPECT_NE(std::strstr(open("folder").text, "directory"), nullptr);

  // Opening must not wait for a writer.
  ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
  EXPECT_EQ(open("pipe").code, ErrorCode::kNotPlanetree);

  struct Foreign {
    std::string bytes;
    const char* said;
  };
  const Foreign foreign[] = {{"", "empty"},
                             {"ply\nformat ascii 1.0\n", "PLY"},
                             {"solid cube\n", "STL"},
                             {"OFF\n3 1 0\n", "OFF"},
                             {"PK\x03\x04zip", "zip"},
                             {"\x01\x02", "starts with 01 02"},
                             {std::string(5000, 'x'), "starts with 78 78 78 78 78 78 78 78"}};
  for (const Foreign& file : foreign) {
    write_bytes(directory / "foreign", std::as_bytes(std::span(file.bytes)));
    const Error error = open("foreign");
    EXPECT_EQ(error.code, ErrorCode::kNotPlanetree) << file.said;
    EXPECT_NE(std::strstr(error.text, file.said), nullptr) << error.text;
  }
}

}  // namespace
}  // namespace planetree::storage
