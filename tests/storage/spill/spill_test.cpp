#include <fcntl.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <random>
#include <vector>

#include "storage/spill/spill_runs.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::storage {
namespace {

std::vector<std::byte> bytes_of(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<std::byte> bytes(count);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

TEST(SpillFile, ReadsBackWhatWasAppended) {
  const TemporaryDirectory directory;
  for (const std::uint64_t held : {0, 5000, 1 << 20}) {
    SpillFile file(directory / ".", held);
    std::vector<std::pair<std::uint64_t, std::vector<std::byte>>> parts;
    for (unsigned i = 0; i < 50; ++i) {
      std::vector<std::byte> bytes = bytes_of(37 * i, i);
      const auto offset = file.append(bytes);
      ASSERT_TRUE(offset) << offset.error().text;
      parts.emplace_back(*offset, std::move(bytes));
    }
    for (const auto& [offset, bytes] : parts) {
      std::vector<std::byte> found(bytes.size());
      ASSERT_TRUE(file.read(offset, found));
      EXPECT_EQ(found, bytes);
      // Also reads parts of one append, on both sides of the border between memory and disk.
      if (bytes.size() < 3) continue;
      found.resize(bytes.size() / 3);
      ASSERT_TRUE(file.read(offset + bytes.size() / 3, found));
      EXPECT_TRUE(std::equal(found.begin(), found.end(), bytes.begin() + bytes.size() / 3));
      ASSERT_TRUE(file.read(offset, found));
      EXPECT_TRUE(std::equal(found.begin(), found.end(), bytes.begin()));
    }
    EXPECT_EQ(file.size_bytes(), 37u * 49 * 50 / 2);
  }
}

TEST(SpillFile, LeavesNoNameInTheDirectory) {
  const TemporaryDirectory directory;
  for (const bool lacks_unnamed_files : {false, true}) {
    FaultyCalls calls;
    calls.lacks_unnamed_files = lacks_unnamed_files;
    SpillFile file(directory / ".", 0, calls);
    ASSERT_TRUE(file.append(bytes_of(100, 1)));
    EXPECT_TRUE(directory.names().empty());
  }
}

// Where the file has a name for a moment, the name can be guessed. A link planted there is neither
// followed nor replaced.
TEST(SpillFile, SkipsAPlantedLink) {
  const TemporaryDirectory directory;
  const std::vector<std::byte> precious = bytes_of(10, 7);
  write_bytes(directory / "precious", precious);
  std::vector<std::string> planted;
  for (int number = 0; number < 40; ++number) {
    planted.push_back(".planetree-" + std::to_string(::getpid()) + "-" + std::to_string(number) +
                      ".spill");
    std::filesystem::create_symlink("precious", directory / planted.back().c_str());
  }
  FaultyCalls calls;
  calls.lacks_unnamed_files = true;
  SpillFile file(directory / ".", 0, calls);
  ASSERT_TRUE(file.append(bytes_of(100, 1)));
  EXPECT_EQ(read_bytes(directory / "precious"), precious);
  for (const std::string& name : planted)
    EXPECT_TRUE(std::filesystem::is_symlink(directory / name.c_str()));
  EXPECT_EQ(directory.names().size(), planted.size() + 1);
}

TEST(SpillFile, ReportsBytesOnDiskAndFailure) {
  const TemporaryDirectory directory;
  FaultyCalls calls;
  SpillFile file(directory / ".", 1000, calls);
  ASSERT_TRUE(file.append(bytes_of(900, 1)));
  EXPECT_EQ(file.disk_bytes(), 0u);
  ASSERT_TRUE(file.append(bytes_of(150, 1)));
  EXPECT_EQ(file.disk_bytes(), 50u);
  EXPECT_EQ(std::filesystem::is_empty(directory / "."), true);
  EXPECT_FALSE(file.failed());
  calls.fault = FaultyCalls::Fault::kError;
  std::vector<std::byte> found(1050);
  const auto read = file.read(0, found);
  ASSERT_FALSE(read);
  EXPECT_STREQ(read.error().text,
               "cannot read a temporary file: Input/output error; check the device and the "
               "system's log");
  EXPECT_TRUE(file.failed());
}

TEST(SpillFile, UsesNoDiskWithinItsMemoryLimit) {
  SpillFile file("/no/such/directory", 1000);
  EXPECT_TRUE(file.append(bytes_of(1000, 1)));
  const auto refused = file.append(bytes_of(1, 1));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNotFound);
  EXPECT_FALSE(file.append(bytes_of(1, 1)));
}

TEST(SpillFile, ResumesInANamedFile) {
  const TemporaryDirectory directory;
  const auto open = [&directory] {
    return FileHandle::open(FileCalls::real(), AT_FDCWD, (directory / "spill").c_str(),
                            O_RDWR | O_CREAT, 0600);
  };
  const std::vector<std::byte> first = bytes_of(100, 1), second = bytes_of(50, 2);
  {
    SpillFile file(open(), 0);
    ASSERT_TRUE(file.append(first));
    ASSERT_TRUE(file.sync());
  }
  SpillFile file(open(), 90);
  const auto offset = file.append(second);
  ASSERT_TRUE(offset);
  EXPECT_EQ(*offset, 90u);
  std::vector<std::byte> found(140);
  ASSERT_TRUE(file.read(0, found));
  EXPECT_TRUE(std::equal(first.begin(), first.begin() + 90, found.begin()));
  EXPECT_TRUE(std::equal(second.begin(), second.end(), found.begin() + 90));
}

// The system reports a lost write only once, to one of the callers.
TEST(SpillFile, SyncFailsForGoodAfterAFailure) {
  const TemporaryDirectory directory;
  FaultyCalls calls;
  SpillFile file(
      FileHandle::open(calls, AT_FDCWD, (directory / "spill").c_str(), O_RDWR | O_CREAT, 0600), 0);
  calls.fault = FaultyCalls::Fault::kError;
  ASSERT_FALSE(file.sync());
  ASSERT_EQ(calls.failed_call(), "fdatasync");
  EXPECT_FALSE(file.sync());
}

struct Record {
  SpillKey key;
  std::uint32_t value = 0;
  std::uint32_t padding = 0;
};

bool precedes(const Record& a, const Record& b) { return a.key < b.key; }

std::vector<std::byte> run_of(std::vector<Record> records) {
  std::sort(records.begin(), records.end(), precedes);
  std::vector<std::byte> bytes(records.size() * sizeof(Record));
  std::memcpy(bytes.data(), records.data(), bytes.size());
  return bytes;
}

struct Keeping {
  std::uint64_t held_bytes;
  Packing packing;
};

class SpillRunsTest : public testing::TestWithParam<Keeping> {
 protected:
  void SetUp() override {
    std::mt19937_64 random(7);
    for (std::uint64_t run = 0; run < 9; ++run) {
      std::vector<Record> records;
      // In the first runs few records share the first half of their key; in the last runs, more
      // share it than lie between two marks.
      const std::uint64_t halves = run < 5 ? 64 : 3;
      for (std::uint64_t i = 0; i < 100 + 300 * run; ++i)
        records.push_back(
            {{7 * (random() % halves), all_.size() + i}, static_cast<std::uint32_t>(i), 0});
      all_.insert(all_.end(), records.begin(), records.end());
      ASSERT_TRUE(runs_.add(run_of(records)));
    }
    ASSERT_TRUE(runs_.add({}));
    std::sort(all_.begin(), all_.end(), precedes);
  }

  const TemporaryDirectory directory_;
  SpillFile file_{directory_ / ".", 0};
  SpillRuns runs_{sizeof(Record), GetParam().held_bytes, file_, GetParam().packing};
  std::vector<Record> all_;
};

TEST_P(SpillRunsTest, FindEveryRecordBetweenTwoKeys) {
  EXPECT_EQ(runs_.size(), all_.size());
  EXPECT_EQ(SpillRuns::count(runs_.begin(), runs_.end()), all_.size());
  for (const SpillKey from : {SpillKey{0, 0}, SpillKey{7, 300}, SpillKey{7, 5000}, SpillKey{40, 0},
                              SpillKey{14, 7000}, SpillKey{470, 0}})
    for (const SpillKey to :
         {SpillKey{7, 301}, SpillKey{7, 7777}, SpillKey{42, 999}, SpillKey{999, 0}}) {
      if (to < from) continue;
      const auto first = runs_.cut(from), last = runs_.cut(to);
      ASSERT_TRUE(first && last);
      const auto bytes = runs_.read(*first, *last);
      ASSERT_TRUE(bytes);
      std::vector<Record> found(bytes->size() / sizeof(Record));
      if (!found.empty()) std::memcpy(found.data(), bytes->data(), bytes->size());
      std::sort(found.begin(), found.end(), precedes);
      std::vector<Record> expected;
      for (const Record& record : all_)
        if (from <= record.key && record.key < to) expected.push_back(record);
      ASSERT_EQ(found.size(), expected.size());
      EXPECT_EQ(SpillRuns::count(*first, *last), expected.size());
      for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(found[i].key, expected[i].key);
    }
}

INSTANTIATE_TEST_SUITE_P(Held, SpillRunsTest,
                         testing::Values(Keeping{0, Packing::kNone}, Keeping{10000, Packing::kNone},
                                         Keeping{1 << 20, Packing::kNone},
                                         Keeping{0, Packing::kGroups},
                                         Keeping{10000, Packing::kGroups}));

class CountedReads final : public FileCalls {
 public:
  ssize_t pread(int descriptor, void* out, std::size_t bytes, off_t offset) noexcept override {
    ++count;
    return FileCalls::pread(descriptor, out, bytes, offset);
  }
  int count = 0;
};

class PackedRunsTest : public testing::TestWithParam<Packing> {};

TEST_P(PackedRunsTest, FindAKeyByOneReadOfEachRun) {
  const TemporaryDirectory directory;
  CountedReads calls;
  SpillFile file(directory / ".", 0, calls);
  SpillRuns runs(sizeof(Record), 0, file, GetParam());
  std::vector<Record> records(100000);
  for (std::uint64_t i = 0; i < records.size(); ++i) records[i].key = {i, i};
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(runs.add(run_of(records)));
  SpillRuns again(sizeof(Record), 0, file);
  for (SpillRuns::Extent& extent : runs.extents()) again.add_extent(std::move(extent));
  for (const std::uint64_t at : {0u, 1u, 255u, 256u, 257u, 70001u, 99999u, 200000u})
    for (const SpillRuns* each : {&runs, &again}) {
      calls.count = 0;
      const auto cut = each->cut({at, 0});
      ASSERT_TRUE(cut);
      EXPECT_EQ(*cut, SpillRuns::Cut(3, std::min<std::uint64_t>(at, records.size())));
      EXPECT_LE(calls.count, 3);
    }
}

INSTANTIATE_TEST_SUITE_P(Packing, PackedRunsTest,
                         testing::Values(Packing::kNone, Packing::kGroups));

// Every stretch of a run, whether it begins and ends within a group or not.
TEST(PackedRuns, GiveBackTheirRecords) {
  const TemporaryDirectory directory;
  SpillFile file(directory / ".", 0), other(directory / ".", 0);
  SpillRuns runs(sizeof(Record), 0, file, Packing::kGroups), plain(sizeof(Record), 0, other);
  std::vector<Record> records(3 * SpillRuns::kMarkRecords + 17);
  std::mt19937_64 random(3);
  for (Record& record : records) record = {{random() % 1000, random()}, 7, 0};
  ASSERT_TRUE(runs.add(run_of(records)));
  ASSERT_TRUE(plain.add(run_of(records)));
  EXPECT_LT(file.size_bytes(), other.size_bytes());
  for (std::uint64_t from = 0; from < records.size(); from += 61)
    for (std::uint64_t to = from; to <= records.size(); to += 83)
      ASSERT_EQ(*runs.read({from}, {to}), *plain.read({from}, {to})) << from << " to " << to;
}

TEST(SpillRuns, AreRestoredFromTheirExtents) {
  const TemporaryDirectory directory;
  SpillFile file(directory / ".", 0);
  SpillRuns runs(sizeof(Record), 0, file), again(sizeof(Record), 0, file);
  for (std::uint64_t i = 0; i < 3; ++i) {
    const auto extent = runs.add(run_of({{{i, 0}, 7, 0}, {{i, 1}, 8, 0}}));
    ASSERT_TRUE(extent);
    EXPECT_EQ(extent->size, 2u);
    EXPECT_EQ(extent->offset, 2 * i * sizeof(Record));
  }
  for (const SpillRuns::Extent& extent : runs.extents()) again.add_extent(extent);
  EXPECT_EQ(again.size(), 6u);
  EXPECT_EQ(*again.read(again.begin(), again.end()), *runs.read(runs.begin(), runs.end()));
}

TEST(SpillRuns, HoldInMemoryNoMoreThanAllowed) {
  const TemporaryDirectory directory;
  SpillFile file(directory / ".", 0);
  SpillRuns runs(sizeof(Record), 3 * 100 * sizeof(Record), file);
  const std::vector<Record> records(100);
  for (int i = 0; i < 5; ++i) ASSERT_TRUE(runs.add(run_of(records)));
  EXPECT_EQ(file.size_bytes(), 2 * 100 * sizeof(Record));
}

}  // namespace
}  // namespace planetree::storage
