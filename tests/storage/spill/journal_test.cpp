#include "storage/spill/journal.h"

#include <fcntl.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/storage/file/file_image.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

struct Note {
  std::uint32_t kind = 0;
  std::string text;
  bool operator==(const Note&) const = default;
};
using Notes = std::vector<Note>;

class JournalTest : public testing::Test {
 protected:
  Journal open(FileCalls& calls) const {
    return Journal(
        FileHandle::open(calls, AT_FDCWD, path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
  }
  // Replays at most `wanted` notes of the journal.
  Notes notes(std::size_t wanted = ~std::size_t{0}) {
    Notes found;
    EXPECT_TRUE(open(calls_).replay([&](std::uint32_t kind, std::span<const std::byte> payload) {
      if (found.size() == wanted) return false;
      found.push_back({kind, {reinterpret_cast<const char*>(payload.data()), payload.size()}});
      return true;
    }));
    return found;
  }
  static Result<void> append(Journal& journal, const Note& note) {
    return journal.append(note.kind, std::as_bytes(std::span(note.text)));
  }
  // Appends after the existing records.
  void append(const Notes& notes) {
    Journal journal = open(calls_);
    ASSERT_TRUE(journal.replay([](std::uint32_t, std::span<const std::byte>) { return true; }));
    for (const Note& note : notes) ASSERT_TRUE(append(journal, note));
  }

  const TemporaryDirectory directory_;
  const std::filesystem::path path_ = directory_ / "journal";
  FaultyCalls calls_;
  const Notes three_{{1, "one"}, {7, ""}, {2, std::string(250, 'x')}};
};

TEST_F(JournalTest, ReplaysWhatWasAppended) {
  EXPECT_EQ(notes(), Notes{});
  append(three_);
  EXPECT_EQ(notes(), three_);
  append({{5, "later"}});
  Notes four = three_;
  four.push_back({5, "later"});
  EXPECT_EQ(notes(), four);
}

TEST_F(JournalTest, ReplayStopsBeforeATornRecord) {
  append(three_);
  const Bytes whole = read_bytes(path_);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_bytes(path_, std::span(whole).first(size));
    const Notes found = notes();
    ASSERT_LT(found.size(), three_.size());
    ASSERT_TRUE(std::equal(found.begin(), found.end(), three_.begin()));
    // Appending continues there.
    append({{9, "new"}});
    Notes expected = found;
    expected.push_back({9, "new"});
    ASSERT_EQ(notes(), expected) << size;
  }
}

TEST_F(JournalTest, ReplayStopsBeforeADamagedRecord) {
  append(three_);
  const Bytes whole = read_bytes(path_);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    Bytes damaged = whole;
    damaged[at] ^= std::byte{0x10};
    write_bytes(path_, damaged);
    const Notes found = notes();
    ASSERT_LT(found.size(), three_.size()) << at;
    ASSERT_TRUE(std::equal(found.begin(), found.end(), three_.begin()));
  }
}

// Otherwise records of the same length could end up after others than those they were written
// after.
TEST_F(JournalTest, DropsAllRecordsAfterARefusedOne) {
  append(three_);
  EXPECT_EQ(notes(1), Notes{three_[0]});
  append({three_[1]});
  EXPECT_EQ(notes(), (Notes{three_[0], three_[1]}));
}

TEST_F(JournalTest, RefusesRecordsThatWereSwapped) {
  append({{1, "first"}, {1, "other"}});
  Bytes bytes = read_bytes(path_);
  const std::size_t half = bytes.size() / 2;
  std::swap_ranges(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(half),
                   bytes.begin() + static_cast<std::ptrdiff_t>(half));
  write_bytes(path_, bytes);
  EXPECT_EQ(notes(), Notes{});
}

TEST_F(JournalTest, AppendsNoMoreAfterAFailure) {
  for (int at = 0;; ++at) {
    std::filesystem::remove(path_);
    FaultyCalls calls;
    Journal journal = open(calls);
    calls.fault = FaultyCalls::Fault::kError;
    calls.fault_at = at;
    std::size_t kept = 0;
    bool failed = false;
    for (const Note& note : three_) {
      const bool appended = static_cast<bool>(append(journal, note));
      EXPECT_FALSE(failed && appended);
      failed = failed || !appended;
      kept += appended ? 1 : 0;
    }
    if (!failed) break;
    // A record that was written but not synced may be present.
    EXPECT_GE(notes().size(), kept);
    EXPECT_LE(notes().size(), kept + 1);
  }
}

}  // namespace
}  // namespace planetree::storage
