#include "storage/set/set_source.h"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "tests/storage/set/sample_set.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

class SetSources : public testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(sample_.write(directory_ / "a.ptree"));
    ASSERT_TRUE(write_set(sample_, path_, 700));
    bytes_ = read_bytes(directory_ / "a.ptree");
    members_ = description_of(path_).members;
    ASSERT_GT(members_.size(), 4u);
  }
  std::filesystem::path member(std::size_t number) const {
    return directory_ / members_[number].address.c_str();
  }
  Error open_error(bool allows_missing = false) const {
    const auto source = open_model_source(path_, {{}, allows_missing});
    EXPECT_FALSE(source);
    return source ? Error() : source.error();
  }

  SampleFile sample_{.page_count = 40};
  TemporaryDirectory directory_;
  const std::filesystem::path path_ = directory_ / "a.ptreeset";
  Bytes bytes_;
  std::vector<SetMember> members_;
};

TEST_F(SetSources, ReadTheJoinedBytes) {
  const auto source = open_model_source(path_);
  ASSERT_TRUE(source) << source.error().text;
  EXPECT_FALSE((*source)->is_remote());
  EXPECT_EQ(bytes_of(**source), bytes_);
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    const std::size_t offset = random() % (bytes_.size() + 1);
    Bytes part(random() % (std::min<std::size_t>(bytes_.size() - offset, 3000) + 1));
    const std::span expected = std::span(bytes_).subspan(offset, part.size());
    ASSERT_TRUE((*source)->read_at(offset, part));
    EXPECT_TRUE(std::ranges::equal(part, expected));
    std::ranges::fill(part, std::byte{});
    if ((*source)->try_read(offset, part, {})) {
      EXPECT_TRUE(std::ranges::equal(part, expected));
    }
    std::ranges::fill(part, std::byte{});
    ASSERT_TRUE((*source)->read_early(offset, part));
    EXPECT_TRUE(std::ranges::equal(part, expected));
  }
}

TEST_F(SetSources, HaveThePagesOfTheFile) {
  auto source = open_model_source(path_);
  ASSERT_TRUE(source);
  const auto file = PageFile::open(*std::move(source));
  ASSERT_TRUE(file) << file.error().text;
  for (std::uint32_t page = 0; page < sample_.page_count; ++page) {
    const auto raw = read_page(*file, page);
    ASSERT_TRUE(raw) << raw.error().text;
    EXPECT_EQ(*raw, sample_.raw(page));
  }
}

TEST_F(SetSources, RefuseReadsBeyondTheEnd) {
  const auto source = open_model_source(path_);
  ASSERT_TRUE(source);
  Bytes part(10);
  for (const std::uint64_t offset : {bytes_.size() - 9, bytes_.size() + 1, ~std::size_t{0} - 3}) {
    const auto read = (*source)->read_at(offset, part);
    ASSERT_FALSE(read);
    EXPECT_EQ(read.error().code, ErrorCode::kTruncated);
    EXPECT_FALSE((*source)->try_read(offset, part, {}));
  }
}

TEST_F(SetSources, NameAMemberThatIsMissing) {
  std::filesystem::remove(member(3));
  const Error error = open_error();
  EXPECT_EQ(error.code, ErrorCode::kNotFound);
  EXPECT_NE(std::string(error.text).find(members_[3].address), std::string::npos) << error.text;
}

TEST_F(SetSources, NameAMemberOfAnotherLength) {
  std::filesystem::resize_file(member(2), members_[2].bytes - 1);
  const Error error = open_error();
  EXPECT_EQ(error.code, ErrorCode::kTruncated);
  EXPECT_NE(std::string(error.text).find(members_[2].address), std::string::npos) << error.text;
}

TEST_F(SetSources, ReadTheRestIfMembersMayBeMissing) {
  const Bytes kept = read_bytes(member(3));
  std::filesystem::remove(member(3));
  const auto source = open_model_source(path_, {{}, true});
  ASSERT_TRUE(source) << source.error().text;
  std::uint64_t at = 0;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    Bytes part(members_[i].bytes);
    const auto read = (*source)->read_at(at, part);
    EXPECT_EQ(static_cast<bool>(read), i != 3);
    if (!read) {
      EXPECT_EQ(read.error().code, ErrorCode::kNotFound);
      EXPECT_NE(std::string(read.error().text).find(members_[3].address), std::string::npos);
    }
    EXPECT_TRUE(i != 3 || !(*source)->try_read(at, part, {}));
    at += part.size();
  }
  // The member comes while the set is open.
  write_bytes(member(3), kept);
  EXPECT_EQ(bytes_of(**source), bytes_);
}

TEST_F(SetSources, RefuseRecordsThatAreNone) {
  write_bytes(path_, Bytes(9, std::byte{'x'}));
  EXPECT_EQ(open_error().code, ErrorCode::kNotPlanetree);
  std::filesystem::remove(path_);
  EXPECT_EQ(open_error().code, ErrorCode::kNotFound);
  write_bytes(path_, Bytes(SetDescription::kMaxBytes + 1, std::byte{' '}));
  EXPECT_EQ(open_error().code, ErrorCode::kNotPlanetree);
}

// A set may not lead to itself.
TEST_F(SetSources, HaveFilesAsMembers) {
  SetDescription description;
  description.members.push_back({.address = "a.ptreeset", .bytes = 10});
  const std::string text = description.text();
  write_bytes(path_, std::as_bytes(std::span(text)));
  EXPECT_EQ(open_error().code, ErrorCode::kTruncated);
}

}  // namespace
}  // namespace planetree::storage
