#include "tools/cli/output_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <optional>
#include <string>
#include <vector>

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

/// A directory for each test, removed afterwards.
class OutputFileTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = testing::TempDir() + "planetree-XXXXXX";
    ASSERT_NE(mkdtemp(pattern.data()), nullptr);
    folder_ = pattern;
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path path(const char* name = "model.ply") const { return folder_ / name; }
  std::size_t file_count() const {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }
  bool has_unnamed_files() const {
    const int file = ::open(folder_.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0600);
    if (file >= 0) ::close(file);
    return file >= 0;
  }
  // Runs `planetree generate` until it has a file open in the folder, and interrupts it.
  void interrupt_generate(const fs::path& mesh) {
    const pid_t process = ::fork();
    if (process == 0) {
      ::execl(PLANETREE_COMMAND, "planetree", "generate", mesh.c_str(), "--triangles", "1G",
              "--quiet", "--force", nullptr);
      ::_exit(127);
    }
    ASSERT_GT(process, 0);
    while (!has_file_open(process) && ::waitpid(process, nullptr, WNOHANG) == 0) ::usleep(1000);
    ASSERT_EQ(::kill(process, SIGINT), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(process, &status, 0), process);
    EXPECT_TRUE(WIFSIGNALED(status));
  }
  bool has_file_open(pid_t process) const {
    std::error_code ignored;
    for (const auto& file :
         fs::directory_iterator("/proc/" + std::to_string(process) + "/fd", ignored))
      if (fs::read_symlink(file, ignored).string().starts_with(folder_.string() + "/")) return true;
    return false;
  }
  static std::string content(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void put(const fs::path& path, const char* text) { std::ofstream(path) << text; }

  fs::path folder_;
};

std::span<const std::byte> bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

TEST_F(OutputFileTest, AppearsOnlyWhenCommitted) {
  auto file = OutputFile::create(path(), false);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->write(bytes_of("one ")));
  ASSERT_TRUE(file->write(bytes_of("two")));
  EXPECT_FALSE(fs::exists(path()));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(content(path()), "one two");
  EXPECT_EQ(file->bytes_written(), 7U);
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(OutputFileTest, RewritesItsFront) {
  for (const bool replaces : {false, true}) {
    auto file = OutputFile::create(path(), true);
    ASSERT_TRUE(file);
    EXPECT_TRUE(file->can_rewrite());
    ASSERT_TRUE(file->write(bytes_of("one ")));
    ASSERT_TRUE(file->write(bytes_of("two")));
    ASSERT_TRUE(file->rewrite_front(bytes_of("ONE")));
    ASSERT_TRUE(file->write(bytes_of(" three")));
    ASSERT_TRUE(file->commit());
    EXPECT_EQ(content(path()), "ONE two three") << replaces;
    EXPECT_EQ(file->bytes_written(), 13U);
  }
  EXPECT_FALSE(OutputFile::create("-", false)->can_rewrite());
  EXPECT_FALSE(OutputFile::create("/dev/null", false)->can_rewrite());
}

TEST_F(OutputFileTest, VanishesWhenAbandoned) {
  put(path("old"), "old");
  for (const char* name : {"new", "old"}) {
    auto file = OutputFile::create(path(name), true);
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write(bytes_of("half")));
    EXPECT_LE(file_count(), has_unnamed_files() ? 1U : 2U);
  }
  EXPECT_EQ(file_count(), 1U);
  EXPECT_EQ(content(path("old")), "old");
}

TEST_F(OutputFileTest, LeavesNothingWhenTheCommandIsInterrupted) {
  if (!has_unnamed_files()) GTEST_SKIP() << "the file system has no files without names";
  put(path("old"), "old");
  interrupt_generate(path("new"));
  interrupt_generate(path("old"));
  EXPECT_EQ(file_count(), 1U);
  EXPECT_EQ(content(path("old")), "old");
}

TEST_F(OutputFileTest, RefusesToReplaceUnlessAllowed) {
  put(path(), "old");
  const auto refused = OutputFile::create(path(), false);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kAlreadyExists);
  auto file = OutputFile::create(path(), true);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->write(bytes_of("new")));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(content(path()), "new");
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(OutputFileTest, RefusesToReplaceWhatAppearedMeanwhile) {
  auto file = OutputFile::create(path(), false);
  ASSERT_TRUE(file);
  put(path(), "other");
  const auto committed = file->commit();
  ASSERT_FALSE(committed);
  EXPECT_EQ(committed.error().code, ErrorCode::kAlreadyExists);
  EXPECT_EQ(content(path()), "other");
}

TEST_F(OutputFileTest, KeepsALinkAndReplacesItsTarget) {
  put(path("target"), "old");
  fs::create_symlink("target", path("link"));
  auto file = OutputFile::create(path("link"), true);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->write(bytes_of("new")));
  ASSERT_TRUE(file->commit());
  EXPECT_TRUE(fs::is_symlink(path("link")));
  EXPECT_EQ(content(path("target")), "new");
}

TEST_F(OutputFileTest, AcceptsTheLongestNameAndUsesTheDefaultMode) {
  const std::string name(255, 'n');
  const mode_t mask = umask(022);
  auto file = OutputFile::create(path(name.c_str()), false);
  umask(mask);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->commit());
  struct stat status {};
  ASSERT_EQ(::stat(path(name.c_str()).c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0644U);
}

TEST_F(OutputFileTest, TwoFilesDoNotInterfere) {
  auto one = OutputFile::create(path("one"), false);
  auto two = OutputFile::create(path("two"), false);
  ASSERT_TRUE(one && two);
  ASSERT_TRUE(one->write(bytes_of("1")) && two->write(bytes_of("2")));
  ASSERT_TRUE(one->commit() && two->commit());
  EXPECT_EQ(content(path("one")) + content(path("two")), "12");
}

TEST_F(OutputFileTest, ErrorCodesNameTheCause) {
  const auto no_folder = OutputFile::create(path("absent/model.ply"), false);
  ASSERT_FALSE(no_folder);
  EXPECT_EQ(no_folder.error().code, ErrorCode::kNotFound);
  const auto folder = OutputFile::create(folder_, true);
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, ErrorCode::kBadArgument);
  const auto long_name = OutputFile::create(path(std::string(300, 'n').c_str()), true);
  ASSERT_FALSE(long_name);
  EXPECT_EQ(long_name.error().code, ErrorCode::kBadArgument);
}

TEST_F(OutputFileTest, ReportsAFullDevice) {
  auto file = OutputFile::create("/dev/full", false);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->reserve(1000));
  const auto written = file->write(bytes_of("x"));
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, ErrorCode::kNoSpace);
  EXPECT_EQ(written.error().offset, 0U);
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
}

/// Limits the size of this process's files while it exists.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) {
    handler_ = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit before_{};
  void (*handler_)(int);
};

TEST_F(OutputFileTest, FailsWhereSpaceRunsOutAndLeavesNothing) {
  const std::vector<std::byte> kilobyte(1000);
  std::optional<Error> error;
  {
    const FileSizeLimit limit(1500);
    auto file = OutputFile::create(path(), false);
    ASSERT_TRUE(file);
    ASSERT_TRUE(file->write(kilobyte));
    const auto written = file->write(kilobyte);
    if (!written) error = written.error();
  }
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, ErrorCode::kNoSpace);
  EXPECT_EQ(error->offset, 1500U);
  EXPECT_EQ(file_count(), 0U);
}

TEST_F(OutputFileTest, ReserveFailsWhereSpaceIsMissing) {
  auto file = OutputFile::create(path(), false);
  ASSERT_TRUE(file);
  EXPECT_TRUE(file->reserve(0));
  const auto space = file->reserve(std::uint64_t{1} << 62);
  ASSERT_FALSE(space);
  EXPECT_EQ(space.error().code, ErrorCode::kNoSpace);
  EXPECT_NE(std::string(space.error().text).find("4611686018427387904"), std::string::npos);
}

TEST_F(OutputFileTest, ReservesWithoutGrowingTheFile) {
  auto file = OutputFile::create(path(), false);
  ASSERT_TRUE(file);
  ASSERT_TRUE(file->reserve(100'000));
  ASSERT_TRUE(file->write(bytes_of("short")));
  ASSERT_TRUE(file->commit());
  EXPECT_EQ(fs::file_size(path()), 5U);
}

}  // namespace
}  // namespace planetree::tools
