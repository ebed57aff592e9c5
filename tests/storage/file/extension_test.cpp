#include "storage/file/extension.h"

#include <gtest/gtest.h>

#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

class Extensions : public testing::Test {
 protected:
  Result<FileHeader> write(std::vector<Extension> extensions) {
    SampleFile sample;
    sample.extensions = std::move(extensions);
    return sample.write(path_, true);
  }
  // Changes the record of an extension and gives the file the right hashes.
  ErrorCode code_with(const std::function<void(ExtensionRecord&)>& change, std::uint32_t of = 0) {
    FileImage image(read_bytes(path_));
    ExtensionRecord record = image.extension(of);
    change(record);
    image.set_extension(of, record);
    image.seal_extensions();
    image.seal_header();
    write_bytes(directory_ / "changed", image.bytes());
    const Result<PageFile> file = PageFile::open(directory_ / "changed");
    return file ? ErrorCode{} : file.error().code;
  }

  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "a.ptree";
  const Bytes long_ = sample_page(1, 3 << 20), short_ = sample_page(2, 5);
};

TEST_F(Extensions, AreReadAsTheyWereWritten) {
  ASSERT_TRUE(write({{"example.org.z", short_, false}, {"a", long_, false}, {"m-1_2", {}, false}}));
  const Result<PageFile> file = PageFile::open(path_);
  ASSERT_TRUE(file);
  ASSERT_EQ(file->extensions().size(), 3u);
  const Bytes expected[] = {long_, short_, {}};
  const char* const names[] = {"a", "example.org.z", "m-1_2"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(name_of(file->extensions()[i]), names[i]);
    EXPECT_EQ(*file->read_extension(file->extensions()[i]), expected[i]);
  }
  EXPECT_EQ(*read_page(*file, 2), SampleFile().raw(2));
}

TEST_F(Extensions, DoNotChangeTheContentId) {
  const Result<FileHeader> without = write({});
  const Result<FileHeader> with = write({{"a", short_, false}});
  ASSERT_TRUE(without && with);
  EXPECT_EQ(without->content_id[0], with->content_id[0]);
  EXPECT_EQ(without->content_id[1], with->content_id[1]);
  EXPECT_NE(without->header_hash, with->header_hash);
}

TEST_F(Extensions, ThatAreRequiredAndNotKnownAreRefused) {
  ASSERT_TRUE(write({{"example.org.new", short_, true}}));
  const Result<PageFile> file = PageFile::open(path_);
  ASSERT_FALSE(file);
  EXPECT_EQ(file.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(std::string(file.error().text).find("example.org.new"), std::string::npos);
}

TEST_F(Extensions, ThatAreDamagedDoNotKeepAFileFromOpening) {
  ASSERT_TRUE(write({{"a", long_, false}, {"b", short_, false}}));
  Bytes bytes = read_bytes(path_);
  bytes[bytes.size() - kHeaderBytes - 1] ^= std::byte{1};
  write_bytes(path_, bytes);
  const Result<PageFile> file = PageFile::open(path_);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->read_extension(file->extensions()[0]));
  const Result<Bytes> damaged = file->read_extension(file->extensions()[1]);
  ASSERT_FALSE(damaged);
  EXPECT_EQ(damaged.error().code, ErrorCode::kDamaged);
}

TEST_F(Extensions, WithWrongRecordsAreRefused) {
  ASSERT_TRUE(write({{"a", short_, false}, {"b", short_, false}}));
  EXPECT_EQ(code_with([](ExtensionRecord&) {}), ErrorCode{});
  const std::function<void(ExtensionRecord&)> changes[] = {
      [](ExtensionRecord& record) { record.name[0] = 'A'; },
      [](ExtensionRecord& record) { record.name[0] = 0; },
      [](ExtensionRecord& record) { record.name[5] = 'c'; },
      [](ExtensionRecord& record) { record.name[0] = 'b'; },
      [](ExtensionRecord& record) { ++record.offset; },
      [](ExtensionRecord& record) { ++record.bytes; },
      [](ExtensionRecord& record) { record.bytes = ~std::uint64_t{0} - record.offset; },
      [](ExtensionRecord& record) { record.required = 2; },
      [](ExtensionRecord& record) { record.reserved[14] = 1; }};
  for (std::size_t i = 0; i < std::size(changes); ++i)
    EXPECT_EQ(code_with(changes[i]), ErrorCode::kDamaged) << i;
  EXPECT_EQ(code_with([](ExtensionRecord& record) { record.name[0] = 'a'; }, 1),
            ErrorCode::kDamaged);
}

TEST_F(Extensions, WithWrongNamesAreNotWritten) {
  for (const char* name : {"", "A", "a b", "0123456789012345678901234", "\xc3\xa4"}) {
    const Result<FileHeader> header = write({{name, short_, false}});
    ASSERT_FALSE(header) << name;
    EXPECT_EQ(header.error().code, ErrorCode::kBadArgument);
  }
  EXPECT_FALSE(write({{"a", short_, false}, {"a", long_, false}}));
  std::vector<Extension> many;
  for (std::uint32_t i = 0; i <= kMaxExtensions; ++i)
    many.push_back({"a" + std::to_string(i), {}, false});
  EXPECT_FALSE(write(many));
  many.pop_back();
  EXPECT_TRUE(write(many));
}

}  // namespace
}  // namespace planetree::storage
