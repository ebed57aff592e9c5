#include "storage/file/page_writer.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

using Names = std::vector<std::string>;

template <class T>
ErrorCode code_of(const Result<T>& result) {
  EXPECT_FALSE(result);
  return result ? ErrorCode{} : result.error().code;
}

TEST(PageWriter, WritesTheSameBytesTwice) {
  const TemporaryDirectory directory;
  const SampleFile sample{26, 64'000};  // more than the write buffer holds
  ASSERT_TRUE(sample.write(directory / "a"));
  ASSERT_TRUE(sample.write(directory / "b"));
  EXPECT_EQ(read_bytes(directory / "a"), read_bytes(directory / "b"));
  EXPECT_GT(std::filesystem::file_size(directory / "a"), 1u << 20);
}

TEST(PageWriter, ContentIdsOfDifferentPagesDiffer) {
  const TemporaryDirectory directory;
  const Result<FileHeader> a = SampleFile{3, 100, 1}.write(directory / "a");
  const Result<FileHeader> b = SampleFile{3, 100, 2}.write(directory / "b");
  ASSERT_TRUE(a && b);
  EXPECT_NE(a->content_id[0], b->content_id[0]);
  EXPECT_NE(a->content_id[1], b->content_id[1]);
}

TEST(PageWriter, RefusesAnExistingDestinationAtOnce) {
  const TemporaryDirectory directory;
  const Bytes old(3, std::byte{7});
  write_bytes(directory / "a", old);
  EXPECT_EQ(code_of(PageWriter::create(directory / "a", 1, {}, false)), ErrorCode::kAlreadyExists);
  EXPECT_EQ(read_bytes(directory / "a"), old);
  EXPECT_TRUE(SampleFile().write(directory / "a", true));
  EXPECT_TRUE(read_all(directory / "a"));
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(PageWriter, ReplacesNothingButFilesAndLinks) {
  const TemporaryDirectory directory;
  std::filesystem::create_directory(directory / "folder");
  EXPECT_EQ(code_of(PageWriter::create(directory / "folder", 1, {}, true)),
            ErrorCode::kAlreadyExists);
  EXPECT_EQ(code_of(PageWriter::create("/dev/null", 1, {}, true)), ErrorCode::kAlreadyExists);
}

TEST(PageWriter, NeverFollowsALinkAtTheDestination) {
  const TemporaryDirectory directory;
  const Bytes precious(10, std::byte{7});
  write_bytes(directory / "precious", precious);
  std::filesystem::create_symlink("precious", directory / "link");
  std::filesystem::create_symlink("nowhere", directory / "dangling");
  EXPECT_EQ(code_of(SampleFile().write(directory / "link")), ErrorCode::kAlreadyExists);
  EXPECT_EQ(code_of(PageWriter::create(directory / "dangling", 1, {}, false)),
            ErrorCode::kAlreadyExists);
  EXPECT_TRUE(SampleFile().write(directory / "link", true));
  EXPECT_TRUE(SampleFile().write(directory / "dangling", true));
  EXPECT_EQ(read_bytes(directory / "precious"), precious);
  EXPECT_FALSE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_TRUE(read_all(directory / "link"));
  EXPECT_EQ(directory.names(), (Names{"dangling", "link", "precious"}));
}

TEST(PageWriter, NeverFollowsALinkCreatedDuringTheBuild) {
  const TemporaryDirectory directory;
  Result<PageWriter> writer = PageWriter::create(directory / "a", 1, {}, false);
  ASSERT_TRUE(writer);
  std::filesystem::create_symlink("nowhere", directory / "a");
  ASSERT_TRUE(writer->append(0, 64, compress_page(sample_page(0, 64))));
  EXPECT_EQ(code_of(writer->finish(sample_model(), kMinPageBytes)), ErrorCode::kAlreadyExists);
  EXPECT_EQ(directory.names(), Names{"a"});
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "a"));
}

TEST(PageWriter, LeavesNothingWhenAbandoned) {
  const TemporaryDirectory directory;
  {
    Result<PageWriter> writer = PageWriter::create(directory / "a", 2, {}, false);
    ASSERT_TRUE(writer);
    ASSERT_TRUE(writer->append(0, 64, compress_page(sample_page(0, 64))));
    EXPECT_EQ(directory.names(), Names{});
  }
  EXPECT_EQ(directory.names(), Names{});
}

TEST(PageWriter, RefusesPathsWithoutADirectoryOrAName) {
  const TemporaryDirectory directory;
  EXPECT_EQ(code_of(PageWriter::create(directory / "no" / "a", 1, {}, false)),
            ErrorCode::kNotFound);
  EXPECT_EQ(code_of(PageWriter::create("", 1, {}, false)), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(PageWriter::create(directory / "", 1, {}, false)), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(PageWriter::create(directory / "..", 1, {}, false)), ErrorCode::kBadArgument);
}

TEST(PageWriter, RefusesPagesOutOfOrder) {
  const TemporaryDirectory directory;
  const StoredPage page = compress_page(sample_page(0, 64));
  const auto second = [&](std::uint64_t octcode) {
    Result<PageWriter> writer = PageWriter::create(directory / "a", 2, {}, false);
    EXPECT_TRUE(writer->append(5, 64, page));
    return writer->append(octcode, 64, page);
  };
  EXPECT_TRUE(second(5));
  EXPECT_TRUE(second(6));
  EXPECT_EQ(code_of(second(4)), ErrorCode::kBadArgument);
}

TEST(PageWriter, FailsForGoodAfterAnError) {
  const TemporaryDirectory directory;
  const StoredPage page = compress_page(sample_page(0, 64));
  Result<PageWriter> writer = PageWriter::create(directory / "a", 2, {}, false);
  ASSERT_TRUE(writer->append(5, 64, page));
  const Result<void> failed = writer->append(4, 64, page);
  ASSERT_FALSE(failed);
  const Result<void> right = writer->append(6, 64, page);
  ASSERT_FALSE(right);
  EXPECT_STREQ(right.error().text, failed.error().text);
}

TEST(PageWriter, RefusesAWrongNumberOfPages) {
  const TemporaryDirectory directory;
  EXPECT_EQ(code_of(PageWriter::create(directory / "a", 0, {}, false)), ErrorCode::kBadArgument);
  const StoredPage page = compress_page(sample_page(0, 64));
  Result<PageWriter> writer = PageWriter::create(directory / "a", 1, {}, false);
  ASSERT_TRUE(writer->append(0, 64, page));
  EXPECT_EQ(code_of(writer->append(1, 64, page)), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(writer->finish(sample_model(), kMinPageBytes)), ErrorCode::kBadArgument);
  Result<PageWriter> early = PageWriter::create(directory / "a", 2, {}, false);
  ASSERT_TRUE(early->append(0, 64, page));
  EXPECT_EQ(code_of(early->finish(sample_model(), kMinPageBytes)), ErrorCode::kBadArgument);
  EXPECT_EQ(directory.names(), Names{});
}

TEST(PageWriter, RefusesModelsThatAReaderWouldRefuse) {
  const TemporaryDirectory directory;
  const auto finish = [&](const ModelRecord& model, std::uint32_t page_bytes) {
    Result<PageWriter> writer = PageWriter::create(directory / "a", 1, {}, false);
    EXPECT_TRUE(writer->append(0, 64, compress_page(sample_page(0, 64))));
    return writer->finish(model, page_bytes);
  };
  ModelRecord model = sample_model();
  model.box_lower[1] = std::nan("");
  EXPECT_EQ(code_of(finish(model, kMinPageBytes)), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(finish(sample_model(), 5000)), ErrorCode::kBadArgument);
  Result<PageWriter> writer = PageWriter::create(directory / "a", 1, {}, false);
  EXPECT_EQ(code_of(writer->append(0, 0, {Codec::kStored, {}})), ErrorCode::kBadArgument);
  EXPECT_EQ(directory.names(), Names{});
}

TEST(PageWriter, RefusesCallsAfterFinish) {
  const TemporaryDirectory directory;
  Result<PageWriter> writer = PageWriter::create(directory / "a", 1, {}, false);
  const StoredPage page = compress_page(sample_page(0, 64));
  ASSERT_TRUE(writer->append(0, 64, page));
  ASSERT_TRUE(writer->finish(sample_model(), kMinPageBytes));
  EXPECT_EQ(code_of(writer->append(1, 64, page)), ErrorCode::kBadArgument);
  EXPECT_EQ(code_of(writer->finish(sample_model(), kMinPageBytes)), ErrorCode::kBadArgument);
  EXPECT_TRUE(read_all(directory / "a"));
}

TEST(PageWriter, LaterOfTwoWritersFailsWithAlreadyExists) {
  const TemporaryDirectory directory;
  Result<PageWriter> first = PageWriter::create(directory / "a", 1, {}, false);
  Result<PageWriter> second = PageWriter::create(directory / "a", 1, {}, false);
  ASSERT_TRUE(first && second);
  ASSERT_TRUE(first->append(0, 64, compress_page(sample_page(0, 64, 1))));
  ASSERT_TRUE(second->append(0, 64, compress_page(sample_page(0, 64, 2))));
  ASSERT_TRUE(second->finish(sample_model(), kMinPageBytes));
  EXPECT_EQ(code_of(first->finish(sample_model(), kMinPageBytes)), ErrorCode::kAlreadyExists);
  EXPECT_EQ((*read_all(directory / "a"))[0], sample_page(0, 64, 2));
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(PageWriter, OnlyOneOfManyWritersSucceedsUnlessReplacing) {
  for (const bool replace : {false, true}) {
    const TemporaryDirectory directory;
    std::atomic<int> won{0};
    std::atomic<int> refused{0};
    std::vector<std::thread> threads;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
      threads.emplace_back([&, seed] {
        const Result<FileHeader> header = SampleFile{3, 120, seed}.write(directory / "a", replace);
        won += header ? 1 : 0;
        refused += !header && header.error().code == ErrorCode::kAlreadyExists ? 1 : 0;
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(won, replace ? 4 : 1);
    EXPECT_EQ(refused, replace ? 0 : 3);
    EXPECT_TRUE(read_all(directory / "a"));
    EXPECT_EQ(directory.names(), Names{"a"});
  }
}

}  // namespace
}  // namespace planetree::storage
