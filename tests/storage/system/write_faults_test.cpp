#include <gtest/gtest.h>

#include <sys/wait.h>
#include <string>

#include <functional>

#include "storage/system/new_file.h"
#include "tests/storage/file/sample_file.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

/// Every system call of writing a file fails once, in every way it can. Afterwards the destination
/// is the old file, absent, or the complete new file, and its directory holds nothing else.
namespace planetree::storage {
namespace {

using Fault = FaultyCalls::Fault;
using Names = std::vector<std::string>;

/// Features of the file system, and whether there is an old file to replace.
struct FileSystem {
  bool replace;
  bool lacks_unnamed_files;
  bool no_proc;
  bool no_noreplace;
};

class WriteFaults : public testing::TestWithParam<FileSystem> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(sample_.write(directory_ / "complete"));
    complete_ = read_bytes(directory_ / "complete");
    std::filesystem::remove(directory_ / "complete");
  }

  FaultyCalls calls(Fault fault, int number, int fault_at, bool every = false) const {
    FaultyCalls made;
    made.lacks_unnamed_files = GetParam().lacks_unnamed_files;
    made.no_proc = GetParam().no_proc;
    made.no_noreplace = GetParam().no_noreplace;
    made.fault = fault;
    made.number = number;
    made.fault_at = fault_at;
    made.every = every;
    return made;
  }

  void reset_destination() {
    std::filesystem::remove(path_);
    if (GetParam().replace) write_bytes(path_, old_);
  }

  bool destination_is_complete() const {
    return std::filesystem::exists(path_) && read_bytes(path_) == complete_;
  }
  bool destination_is_as_before() const {
    if (!GetParam().replace) return !std::filesystem::exists(path_);
    return std::filesystem::exists(path_) && read_bytes(path_) == old_;
  }
  Names names_without_debris() const {
    return std::filesystem::exists(path_) ? Names{"a.ptree"} : Names{};
  }

  // Fails the n-th call for every n until a run has no fault; returns the number of calls.
  int for_every_call(
      Fault fault, int number, bool every,
      const std::function<void(const FaultyCalls&, const Result<FileHeader>&)>& check) {
    for (int fault_at = 0;; ++fault_at) {
      reset_destination();
      FaultyCalls made = calls(fault, number, fault_at, every);
      const Result<FileHeader> header = sample_.write(path_, GetParam().replace, made);
      EXPECT_EQ(directory_.names(), names_without_debris())
          << "call " << fault_at << ", " << made.failed_call();
      if (header) {
        EXPECT_TRUE(destination_is_complete());
      }
      if (!made.happened()) {
        EXPECT_TRUE(header);
        return fault_at;
      }
      check(made, header);
    }
  }

  SampleFile sample_;
  TemporaryDirectory directory_;
  std::filesystem::path path_ = directory_ / "a.ptree";
  Bytes complete_;
  Bytes old_ = Bytes(17, std::byte{42});
};

TEST_P(WriteFaults, AFailedCallIsACleanError) {
  for (const int number : {EIO, ENOSPC}) {
    const ErrorCode code = number == EIO ? ErrorCode::kWriteFailed : ErrorCode::kNoSpace;
    int error_count = 0;
    const int call_count = for_every_call(
        Fault::kError, number, false,
        [&](const FaultyCalls& made, const Result<FileHeader>& header) {
          if (header) return;
          ++error_count;
          EXPECT_EQ(header.error().code, code) << made.failed_call();
          // When the directory is synced, the file already has its name.
          const bool named = made.failed_call() == "fsync" && made.fsync_count() == 2;
          EXPECT_TRUE(named ? destination_is_complete() : destination_is_as_before())
              << made.failed_call();
        });
    EXPECT_GE(call_count, 10);
    EXPECT_GE(error_count, 9);
  }
}

TEST_P(WriteFaults, ADiskThatStaysFullIsACleanError) {
  for_every_call(Fault::kError, ENOSPC, true,
                 [&](const FaultyCalls& made, const Result<FileHeader>& header) {
                   if (header) return;
                   EXPECT_EQ(header.error().code, ErrorCode::kNoSpace) << made.failed_call();
                 });
}

TEST_P(WriteFaults, AnInterruptedCallIsResumed) {
  const int call_count =
      for_every_call(Fault::kInterrupt, EINTR, false,
                     [](const FaultyCalls& made, const Result<FileHeader>& header) {
                       EXPECT_TRUE(header) << made.failed_call();
                     });
  EXPECT_GE(call_count, 6);
}

TEST_P(WriteFaults, AShortWriteIsResumed) {
  for (const bool every : {false, true}) {
    const int call_count = for_every_call(
        Fault::kShort, 0, every,
        [](const FaultyCalls&, const Result<FileHeader>& header) { EXPECT_TRUE(header); });
    EXPECT_GE(call_count, 4);
  }
}

TEST_P(WriteFaults, AFailedSyncIsNotRetried) {
  const int call_count = for_every_call(
      Fault::kError, EIO, false, [&](const FaultyCalls& made, const Result<FileHeader>& header) {
        if (made.failed_call() != "fsync") return;
        ASSERT_FALSE(header);
        EXPECT_EQ(header.error().code, ErrorCode::kWriteFailed);
        if (made.fsync_count() == 1) {
          EXPECT_TRUE(destination_is_as_before());
        } else {
          EXPECT_EQ(made.fsync_count(), 2);
          const std::string text = header.error().text;
          EXPECT_NE(text.find("the file is complete under its name"), std::string::npos) << text;
        }
      });
  EXPECT_GE(call_count, 10);
}

TEST_P(WriteFaults, DestinationCreatedMeanwhileIsKept) {
  if (GetParam().replace) GTEST_SKIP() << "replacing was asked for";
  FaultyCalls made = calls(Fault::kNone, 0, 0);
  Result<PageWriter> writer = PageWriter::create(path_, 1, {}, false, made);
  ASSERT_TRUE(writer);
  ASSERT_TRUE(writer->append(0, 64, compress_page(sample_page(0, 64))));
  write_bytes(path_, old_);
  const Result<FileHeader> header = writer->finish(sample_model(), kMinPageBytes);
  ASSERT_FALSE(header);
  EXPECT_EQ(header.error().code, ErrorCode::kAlreadyExists);
  EXPECT_EQ(read_bytes(path_), old_);
  EXPECT_EQ(directory_.names(), Names{"a.ptree"});
}

// The process is killed before its n-th call.
TEST_P(WriteFaults, AKilledBuildLeavesOldOrComplete) {
  const bool named = GetParam().lacks_unnamed_files || GetParam().no_proc;
  for (int fault_at = 0;; ++fault_at) {
    reset_destination();
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      FaultyCalls made = calls(Fault::kKill, 0, fault_at);
      _exit(sample_.write(path_, GetParam().replace, made) ? 0 : 1);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(destination_is_as_before() || destination_is_complete()) << fault_at;
    // A killed process cannot remove the temporary name of its file; it leaves one at most.
    const Names names = directory_.names();
    const std::size_t allowed = named || GetParam().replace ? 1 : 0;
    EXPECT_LE(names.size(), names_without_debris().size() + allowed) << fault_at;
    for (const std::string& name : names) {
      if (name != "a.ptree") std::filesystem::remove(directory_ / name.c_str());
    }
    if (WIFEXITED(status)) {
      EXPECT_EQ(WEXITSTATUS(status), 0);
      EXPECT_TRUE(destination_is_complete());
      EXPECT_GE(fault_at, 10);
      return;
    }
  }
}

// Temporary names can be guessed. A link planted there is neither followed nor replaced.
TEST(TemporaryNames, PlantedLinkIsSkipped) {
  const TemporaryDirectory directory;
  const Bytes precious(10, std::byte{7});
  write_bytes(directory / "precious", precious);
  FaultyCalls made;
  made.lacks_unnamed_files = true;
  std::string name;
  {
    const Result<NewFile> first = NewFile::create(directory / "a", false, made);
    ASSERT_TRUE(first);
    name = directory.names().front();
  }
  const std::size_t number_at = name.rfind('-') + 1;
  const int next = std::stoi(name.substr(number_at)) + 1;
  const std::string planted = name.substr(0, number_at) + std::to_string(next) + ".tmp";
  std::filesystem::create_symlink("precious", directory / planted.c_str());
  EXPECT_TRUE(SampleFile().write(directory / "a", false, made));
  EXPECT_EQ(read_bytes(directory / "precious"), precious);
  EXPECT_EQ(directory.names(), (Names{planted, "a", "precious"}));
  EXPECT_TRUE(std::filesystem::is_symlink(directory / planted.c_str()));
}

std::string name_of(const testing::TestParamInfo<FileSystem>& file_system) {
  std::string name = file_system.param.replace ? "Replace" : "Create";
  if (file_system.param.lacks_unnamed_files) name += "WithoutUnnamedFiles";
  if (file_system.param.no_proc) name += "WithoutProc";
  if (file_system.param.no_noreplace) name += "WithoutNoReplace";
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Storage, WriteFaults,
    testing::Values(FileSystem{false, false, false, false}, FileSystem{true, false, false, false},
                    FileSystem{false, true, false, false}, FileSystem{true, true, false, false},
                    FileSystem{false, false, true, false}, FileSystem{false, true, false, true}),
    name_of);

}  // namespace
}  // namespace planetree::storage
