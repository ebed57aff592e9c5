// Builds by the command itself: on disks that fill up, several at once, and with links planted.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <random>

#include "tests/storage/file/file_image.h"
#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

#ifdef PLANETREE_COMMAND
using Names = std::vector<std::string>;

Outcome shell(const std::string& script) {
  Outcome outcome;
  std::FILE* const pipe = popen(("exec 2>&1; " + script).c_str(), "r");
  if (pipe == nullptr) return {-1, {}, {}};
  char part[4096];
  while (const std::size_t size = std::fread(part, 1, sizeof part, pipe))
    outcome.output.append(part, size);
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

class BuildFaults : public Command {
 protected:
  // Writes faces between random vertices. Few edges match others, which takes more space than is
  // predicted for a mesh with so few vertices.
  static void write_tangle(const fs::path& path) {
    constexpr std::uint32_t kVertices = 20000, kFaces = 40000;
    std::mt19937 random(3);
    std::uniform_real_distribution<float> coordinate(0, 1);
    std::string bytes =
        "ply\nformat binary_little_endian 1.0\nelement vertex 20000\nproperty float x\nproperty "
        "float y\nproperty float z\nelement face 40000\nproperty list uchar uint "
        "vertex_indices\nend_header\n";
    const auto put = [&bytes](const auto& value) {
      bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    for (std::uint32_t i = 0; i < 3 * kVertices; ++i) put(coordinate(random));
    for (std::uint32_t i = 0; i < kFaces; ++i) {
      put(std::uint8_t{3});
      for (int k = 0; k < 3; ++k) put(static_cast<std::uint32_t>(random() % kVertices));
    }
    write(path, bytes);
  }

  static std::string build(const std::string& arguments) {
    return std::string(PLANETREE_COMMAND) + " build --quiet " + arguments;
  }
  static std::string on_small_disk(const std::string& size, const std::string& script) {
    return "unshare --map-root-user --mount sh -c 'mount -t tmpfs -o size=" + size +
           " tmpfs small && { " + script + "; }'";
  }

  static Names names(const fs::path& folder) {
    Names names;
    for (const auto& entry : fs::directory_iterator(folder))
      names.push_back(entry.path().filename().string());
    return names;
  }
};

/// Has a directory `small` that can be mounted as a disk of its own.
class BuildOnSmallDisk : public BuildFaults {
 protected:
  void SetUp() override {
    BuildFaults::SetUp();
    fs::create_directory("small");
    fs::create_directory("out");
    if (shell(on_small_disk("1M", "true")).status != 0)
      GTEST_SKIP() << "nothing may be mounted here";
  }
};

TEST_F(BuildOnSmallDisk, RefusesABuildThatNeedsMoreSpaceThanThereIs) {
  ASSERT_EQ(run({"generate", "model.ply", "--triangles", "100K", "--quiet"}).status, 0);
  const Outcome refused = shell(on_small_disk(
      "8M", build("model.ply -o out/new.ptree --memory 160M --temp-dir small") + "; echo $?"));
  EXPECT_EQ(refused.output,
            "planetree: small: temporary files may take 13 MiB, and the device has 8 MiB free; "
            "free some, name a --temp-dir with more space, or give more --memory\n3\n");
  EXPECT_EQ(names("out"), Names{});
  const Outcome with_more_memory =
      shell(on_small_disk("8M", build("model.ply -o out/new.ptree --memory 1G --temp-dir small")));
  EXPECT_EQ(with_more_memory.status, 0) << with_more_memory.output;
  // A checkpoint is on disk, however much memory there is.
  const Outcome resumable = shell(on_small_disk(
      "6M", build("model.ply -o out/new.ptree --force --resume --memory 1G --temp-dir small") +
                "; echo $?; ls -A small"));
  EXPECT_TRUE(resumable.output.starts_with("planetree: small: temporary files may take "))
      << resumable.output;
  EXPECT_TRUE(resumable.output.ends_with("\n3\n")) << resumable.output;
}

TEST_F(BuildOnSmallDisk, LeavesNothingWhenTemporaryFilesFillIt) {
  write_tangle("tangle.ply");
  const Outcome full = shell(on_small_disk(
      "8M", build("tangle.ply -o out/new.ptree --memory 160M --temp-dir small") +
                "; echo $?; ls -A small; stat --file-system --format=\"%b %f\" small"));
  const auto lines = lines_of(full.output);
  ASSERT_EQ(lines.size(), 3u) << full.output;
  EXPECT_TRUE(lines[0].starts_with("planetree: small: at byte "));
  EXPECT_TRUE(
      lines[0].ends_with(": cannot write a temporary file: No space left on device; free "
                         "some space or choose another device"))
      << lines[0];
  EXPECT_EQ(lines[1], "3");
  EXPECT_EQ(lines[2], "2048 2048") << "blocks that there are, and that are free";
  EXPECT_EQ(names("out"), Names{});
}

TEST_F(BuildOnSmallDisk, LeavesTheOldFileWhenTheNewOneFillsIt) {
  write_tangle("tangle.ply");
  const Outcome full =
      shell(on_small_disk("1M", "echo old >small/new.ptree; " +
                                    build("tangle.ply -o small/new.ptree --memory 4G --force") +
                                    "; echo $?; ls -A small; cat small/new.ptree"));
  const auto lines = lines_of(full.output);
  ASSERT_EQ(lines.size(), 4u) << full.output;
  EXPECT_TRUE(lines[0].starts_with("planetree: small/new.ptree: at byte "));
  EXPECT_TRUE(lines[0].ends_with(
      ": cannot write the file: No space left on device; free some space or choose another device"))
      << lines[0];
  EXPECT_EQ(Names(lines.begin() + 1, lines.end()), (Names{"3", "new.ptree", "old"}));
}

TEST_F(BuildOnSmallDisk, ErrorNamesTheReadOnlyDirectory) {
  const Outcome output = shell(on_small_disk(
      "1M", "mount -o remount,ro small; " + build("mesh.obj -o small/new.ptree") + "; echo $?"));
  EXPECT_EQ(output.output,
            "planetree: small/new.ptree: cannot write to its directory: Read-only file system; "
            "choose a directory that can be written\n3\n");
  const Outcome temporary = shell(on_small_disk(
      "1M", "mount -o remount,ro small; " +
                build("mesh.obj -o out/new.ptree --memory 160M --temp-dir small") + "; echo $?"));
  EXPECT_EQ(temporary.output,
            "planetree: small: cannot create a temporary file: Read-only file system; choose a "
            "directory that can be written\n3\n");
}

TEST_F(BuildFaults, FileSizeLimitIsReportedForTheFileThatReachesIt) {
  ASSERT_EQ(run({"generate", "model.ply", "--triangles", "20K", "--quiet"}).status, 0);
  fs::create_directory("out");
  fs::create_directory("temporary");
  for (const auto& [memory, position] : {std::pair("160M", "temporary"), {"1G", "out/new.ptree"}}) {
    const Outcome limited =
        shell("ulimit -f 100; " +
              build("model.ply -o out/new.ptree --temp-dir temporary --memory ") + memory);
    EXPECT_EQ(limited.status, 3);
    EXPECT_TRUE(limited.output.starts_with(std::string("planetree: ") + position + ": at byte "));
    EXPECT_NE(limited.output.find("File too large; raise the limit of file sizes or choose another "
                                  "device\n"),
              std::string::npos)
        << limited.output;
    EXPECT_EQ(names("out"), Names{});
    EXPECT_EQ(names("temporary"), Names{});
  }
}

TEST_F(BuildFaults, CheckpointThatCannotBeWrittenIsReported) {
  ASSERT_EQ(run({"generate", "model.ply", "--triangles", "20K", "--quiet"}).status, 0);
  fs::create_directory("out");
  const Outcome limited =
      shell("ulimit -f 100; " + build("model.ply -o out/new.ptree --resume --memory 1G"));
  EXPECT_EQ(limited.status, 3);
  EXPECT_TRUE(limited.output.starts_with("planetree: out/new.ptree.work: at byte "))
      << limited.output;
  EXPECT_EQ(names("out"), Names{});
}

// The page size identifies the build that wrote the file.
TEST_F(BuildFaults, OneOfTwoConcurrentBuildsWins) {
  ASSERT_EQ(run({"generate", "model.ply", "--triangles", "50K", "--quiet"}).status, 0);
  std::vector<storage::Bytes> expected;
  for (const char* page_bytes : {"4K", "64K"}) {
    ASSERT_EQ(run({"build", "model.ply", "-o", page_bytes, "--page-size", page_bytes}).status, 0);
    expected.push_back(storage::read_bytes(page_bytes));
  }
  fs::create_directory("out");
  for (const std::string force : {"", " --force"}) {
    for (int round = 0; round < 3; ++round) {
      fs::remove("out/new.ptree");
      const std::string one = build("model.ply -o out/new.ptree" + force);
      std::string two = "{ " + one;
      two += " --page-size 4K >4K.txt 2>&1; echo $? >4K.status; } & " + one;
      two += " --page-size 64K >64K.txt 2>&1; echo $? >64K.status; wait";
      const Outcome both = shell(two);
      const std::string small_status = text_of("4K.status"), large_status = text_of("64K.status");
      const auto found = storage::read_bytes("out/new.ptree");
      EXPECT_EQ(names("out"), Names{"new.ptree"});
      if (force.empty()) {
        const bool small_won = small_status == "0\n";
        EXPECT_EQ(large_status, small_won ? "2\n" : "0\n");
        EXPECT_EQ(small_status, small_won ? "0\n" : "2\n");
        EXPECT_EQ(found, expected[small_won ? 0 : 1]);
        const std::string lost = text_of(small_won ? "64K.txt" : "4K.txt");
        EXPECT_TRUE(lost.starts_with("planetree: out/new.ptree: ")) << lost;
      } else {
        EXPECT_EQ(small_status + large_status, "0\n0\n");
        EXPECT_TRUE(found == expected[0] || found == expected[1]);
      }
    }
  }
}

TEST_F(BuildFaults, FollowsNoLinkAtItsDestination) {
  write("precious", "precious");
  fs::create_symlink("precious", "link.ptree");
  EXPECT_EQ(shell(build("mesh.obj -o link.ptree")).status, 2);
  EXPECT_TRUE(fs::is_symlink("link.ptree"));
  EXPECT_EQ(shell(build("mesh.obj -o link.ptree --force")).status, 0);
  EXPECT_FALSE(fs::is_symlink("link.ptree"));
  EXPECT_EQ(text_of("precious"), "precious");
}
#endif

}  // namespace
}  // namespace planetree::tools
