#include "storage/file/metadata.h"

#include <gtest/gtest.h>

#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

Result<Metadata> parse(std::string_view text) {
  return parse_metadata(std::as_bytes(std::span(text.data(), text.size())));
}

TEST(MetadataText, IsReadAsItWasWritten) {
  const Metadata metadata = {{"unit", "mm"},
                             {"crs", "EPSG:25832: ETRS89 / UTM zone 32N"},
                             {"title", "L\xc3\xb6we, \xf0\x9f\xa6\x81"},
                             {"a_0", " "}};
  ASSERT_TRUE(check_metadata(metadata));
  const TemporaryDirectory directory;
  SampleFile sample;
  sample.extensions = extensions_of(metadata);
  ASSERT_TRUE(sample.write(directory / "a.ptree"));
  const Result<PageFile> file = PageFile::open(directory / "a.ptree");
  ASSERT_TRUE(file);
  ASSERT_EQ(file->extensions().size(), 1u);
  EXPECT_EQ(*read_metadata(*file), metadata);
}

TEST(MetadataText, IsEmptyWithoutTheExtension) {
  EXPECT_TRUE(extensions_of({}).empty());
  EXPECT_TRUE(parse("")->empty());
}

TEST(MetadataText, IsLinesOfKeysAndValues) {
  const Extension extension = extensions_of({{"unit", "mm"}, {"crs", "x"}}).front();
  const std::string_view text(reinterpret_cast<const char*>(extension.bytes.data()),
                              extension.bytes.size());
  EXPECT_EQ(text, "crs: x\nunit: mm\n");
  EXPECT_FALSE(extension.required);
}

TEST(MetadataText, ThatBreaksARuleIsRefused) {
  const std::string long_key(65, 'a');
  const std::string big = "a: " + std::string(65536, 'x') + "\n";
  for (const std::string& text : {std::string("unit: mm"),
                                  std::string("unit mm\n"),
                                  std::string("unit:mm\n"),
                                  std::string("Unit: mm\n"),
                                  std::string(": mm\n"),
                                  std::string("unit: \n"),
                                  std::string("b: x\na: x\n"),
                                  std::string("a: x\na: x\n"),
                                  std::string("a: x\n\n"),
                                  std::string("a: \t\n"),
                                  std::string("a: \x7f\n"),
                                  std::string("a: \xff\n"),
                                  std::string("a: \xc3\n"),
                                  std::string("a: \xc0\x80\n"),
                                  std::string("a: \xed\xa0\x80\n"),
                                  std::string("a: \xe0\x80\x80\n"),
                                  std::string("a: \xf0\x80\x80\x80\n"),
                                  std::string("a: \xf4\x90\x80\x80\n"),
                                  std::string("a: x\0y\n", 7),
                                  long_key + ": x\n",
                                  big}) {
    const Result<Metadata> metadata = parse(text);
    ASSERT_FALSE(metadata) << text.substr(0, 80);
    EXPECT_EQ(metadata.error().code, ErrorCode::kDamaged);
  }
  EXPECT_TRUE(parse(std::string(64, 'a') + ": x\n"));
}

TEST(MetadataText, ThatBreaksARuleIsNotWritten) {
  for (const Metadata& metadata :
       {Metadata{{"Unit", "mm"}}, Metadata{{"", "mm"}}, Metadata{{"unit", ""}},
        Metadata{{"unit", "a\nb"}}, Metadata{{"unit", "\xff"}},
        Metadata{{"a", std::string(65533, 'x')}}}) {
    const Result<void> checked = check_metadata(metadata);
    ASSERT_FALSE(checked);
    EXPECT_EQ(checked.error().code, ErrorCode::kBadArgument);
  }
  EXPECT_TRUE(check_metadata({{"a", std::string(65532, 'x')}}));
}

TEST(MetadataText, OfDamagedBytesIsAnError) {
  const TemporaryDirectory directory;
  SampleFile sample;
  sample.extensions = {{std::string(kMetadataName), Bytes(70'000, std::byte{'x'}), false}};
  ASSERT_TRUE(sample.write(directory / "a.ptree"));
  const Result<PageFile> file = PageFile::open(directory / "a.ptree");
  ASSERT_TRUE(file);
  const Result<Metadata> metadata = read_metadata(*file);
  ASSERT_FALSE(metadata);
  EXPECT_EQ(metadata.error().code, ErrorCode::kDamaged);
}

}  // namespace
}  // namespace planetree::storage
