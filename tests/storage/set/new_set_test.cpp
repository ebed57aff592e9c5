#include "storage/set/new_set.h"

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include "tests/storage/set/sample_set.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

class NewSets : public testing::Test {
 protected:
  // What a set of the sample is, joined.
  Bytes one_file() const {
    TemporaryDirectory directory;
    EXPECT_TRUE(sample_.write(directory / "one"));
    return read_bytes(directory / "one");
  }
  Bytes joined() const {
    Bytes bytes;
    for (const SetMember& member : description_of(path_).members) {
      const Bytes part = read_bytes(directory_ / member.address.c_str());
      EXPECT_EQ(part.size(), member.bytes);
      EXPECT_EQ(hash128(part), member.hash);
      bytes.insert(bytes.end(), part.begin(), part.end());
    }
    return bytes;
  }

  SampleFile sample_{.page_count = 40};
  TemporaryDirectory directory_;
  const std::filesystem::path path_ = directory_ / "a.ptreeset";
};

TEST_F(NewSets, HaveTheBytesOfTheFile) {
  sample_.extensions.push_back({"note", Bytes(300, std::byte{7})});
  const Bytes expected = one_file();
  for (const std::uint64_t member_bytes : {1, 500, 1000, 1'000'000}) {
    const auto header = write_set(sample_, path_, member_bytes, true);
    ASSERT_TRUE(header) << header.error().text;
    EXPECT_EQ(joined(), expected) << member_bytes;
    const SetDescription description = description_of(path_);
    EXPECT_EQ(description.content_id, (Hash128{header->content_id[0], header->content_id[1]}));
    std::uint32_t pages = 0;
    for (const SetMember& member : description.members) {
      if (member.pages > 1) {
        EXPECT_LE(member.bytes, member_bytes);
      }
      ASSERT_EQ(member.box.has_value(), member.pages > 0);
      pages += member.pages;
      if (!member.box) continue;
      EXPECT_EQ(member.box->lower[0], pages - member.pages);
      EXPECT_EQ(member.box->upper[0], pages);
    }
    EXPECT_EQ(pages, sample_.page_count);
    if (member_bytes == 1'000'000) {
      EXPECT_EQ(description.members.size(), 2u);
    }
    // Nothing but the set file and its members is left, whatever was there before.
    EXPECT_EQ(directory_.names().size(), description.members.size() + 1);
  }
}

TEST_F(NewSets, NeverHaveTooManyMembers) {
  sample_.page_count = 300;
  const auto header = write_set(sample_, path_, 1);
  ASSERT_FALSE(header);
  EXPECT_EQ(header.error().code, ErrorCode::kBadArgument);
  EXPECT_TRUE(directory_.names().empty());
}

TEST_F(NewSets, RefuseOtherNames) {
  const auto code = [this](const char* name) {
    const auto written = write_set(sample_, directory_ / name, 1000);
    return written ? ErrorCode::kCancelled : written.error().code;
  };
  EXPECT_EQ(code("a.ptree"), ErrorCode::kBadArgument);
  EXPECT_EQ(code("a\xff.ptreeset"), ErrorCode::kBadArgument);
  ASSERT_TRUE(write_set(sample_, path_, 1000));
  EXPECT_EQ(code("a.ptreeset"), ErrorCode::kAlreadyExists);
  EXPECT_EQ(joined(), one_file());
}

TEST_F(NewSets, LeaveFilesOfOthersAlone) {
  write_bytes(directory_ / "a.0.part", Bytes(3));
  // The set file of another program's set.
  SetDescription other;
  for (const char* address : {"a.0.part", "b.part", "/tmp/x/a.1.part", "a.txt"})
    other.members.push_back({.address = address, .bytes = 1});
  write_bytes(directory_ / "b.part", Bytes(3));
  write_bytes(directory_ / "a.txt", Bytes(3));
  const std::string text = other.text();
  write_bytes(path_, std::as_bytes(std::span(text)));
  ASSERT_TRUE(write_set(sample_, path_, 1'000'000, true));
  const auto names = directory_.names();
  const auto has = [&names](const char* name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  EXPECT_FALSE(has("a.0.part"));  // a member of the set that was replaced
  EXPECT_TRUE(has("b.part"));
  EXPECT_TRUE(has("a.txt"));
}

// After each failed call there is the earlier set or the new one, whole, and nothing else.
TEST_F(NewSets, AreWholeOrAbsentAfterEachFault) {
  const Bytes expected = one_file();
  SampleFile old{.page_count = 9, .seed = 2};
  FaultyCalls idle;  // does not wait for the disk
  for (const bool replaces : {false, true}) {
    for (const bool lacks_unnamed_files : {false, true}) {
      int fault_at = 0;
      for (;; ++fault_at) {
        std::filesystem::remove_all(directory_ / "");
        std::filesystem::create_directory(directory_ / "");
        if (replaces) {
          ASSERT_TRUE(write_set(old, path_, 500, false, idle));
        }
        const auto before = directory_.names();
        FaultyCalls calls;
        calls.fault = FaultyCalls::Fault::kError;
        calls.fault_at = fault_at;
        calls.lacks_unnamed_files = lacks_unnamed_files;
        const auto written = write_set(sample_, path_, 1000, replaces, calls);
        SCOPED_TRACE(std::to_string(fault_at) + " " + calls.failed_call());
        // A fault while the directory is synced, or while old members are removed, is after the
        // end.
        const bool is_new = std::filesystem::exists(path_) &&
                            description_of(path_).members.size() > 4 && joined() == expected;
        if (written) {
          EXPECT_TRUE(is_new);
        } else if (!is_new) {
          EXPECT_EQ(directory_.names(), before);
        }
        if (!calls.happened()) break;
      }
      EXPECT_GT(fault_at, 30);
    }
  }
}

// A member never has the name of one with other bytes, also where a model is divided in two ways.
TEST_F(NewSets, NameMembersByTheirBytes) {
  FaultyCalls idle;
  ASSERT_TRUE(write_set(sample_, path_, 500, false, idle));
  ASSERT_TRUE(write_set(sample_, directory_ / "b.ptreeset", 1000, false, idle));
  const SetDescription one = description_of(path_);
  const SetDescription other = description_of(directory_ / "b.ptreeset");
  ASSERT_NE(one.members.size(), other.members.size());
  for (const SetMember& a : one.members)
    for (const SetMember& b : other.members)
      EXPECT_TRUE(a.address.substr(1) != b.address.substr(1) || a.hash == b.hash);
  // What is before the pages is the same, and named so.
  EXPECT_EQ(one.members[0].address.substr(1), other.members[0].address.substr(1));
  EXPECT_NE(one.members[1].address.substr(1), other.members[1].address.substr(1));
}

// A killed process leaves the earlier set, or the new one, whole. What else it leaves is replaced
// by the next one.
TEST_F(NewSets, AreWholeAfterEachKill) {
  const Bytes expected = one_file();
  SampleFile old{.page_count = 9, .seed = 2};
  FaultyCalls idle;  // does not wait for the disk
  int kills = 0;
  for (int fault_at = 0;; fault_at += 3) {
    std::filesystem::remove_all(directory_ / "");
    std::filesystem::create_directory(directory_ / "");
    // Another model, or the same one in other members.
    ASSERT_TRUE(write_set(fault_at % 2 == 0 ? old : sample_, path_, 500, false, idle));
    const Bytes before = joined();
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      FaultyCalls calls;
      calls.fault = FaultyCalls::Fault::kKill;
      calls.fault_at = fault_at;
      ::_exit(write_set(sample_, path_, 1000, true, calls) ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    const Bytes after = joined();
    EXPECT_TRUE(after == before || after == expected) << fault_at;
    ASSERT_TRUE(write_set(sample_, path_, 1000, true, idle));
    EXPECT_EQ(joined(), expected);
    if (!WIFSIGNALED(status)) break;
    ++kills;
  }
  EXPECT_GT(kills, 10);
}

}  // namespace
}  // namespace planetree::storage
