// A command that succeeds leaves standard error empty, whatever the system allows it.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/storage/system/temporary_directory.h"

namespace planetree::tools {
namespace {

/// While it lives, this thread and the processes that it starts use one processor.
class OneProcessor {
 public:
  OneProcessor() {
    ::sched_getaffinity(0, sizeof before_, &before_);
    cpu_set_t one;
    CPU_ZERO(&one);
    for (int i = 0; CPU_COUNT(&one) == 0; ++i)
      if (CPU_ISSET(i, &before_)) CPU_SET(i, &one);
    ::sched_setaffinity(0, sizeof one, &one);
  }
  OneProcessor(const OneProcessor&) = delete;
  OneProcessor& operator=(const OneProcessor&) = delete;
  ~OneProcessor() { ::sched_setaffinity(0, sizeof before_, &before_); }

 private:
  cpu_set_t before_;
};

// Ends this process, or any that it becomes, if it tries to set up an io_uring.
bool forbid_io_uring() {
  std::array<sock_filter, 4> filter{{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_io_uring_setup, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_KILL_PROCESS),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  }};
  sock_fprog program{static_cast<unsigned short>(filter.size()), filter.data()};
  return ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
         ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program) == 0;
}

class SilentSuccess : public testing::Test {
 protected:
  // Runs the program and returns what it writes to standard error.
  std::string errors_of(const std::string& arguments) {
    const std::string at = (folder_ / ".").string();
    const std::string line =
        "cd '" + at + "' && '" PLANETREE_COMMAND "' " + arguments + " >output 2>errors";
    EXPECT_EQ(std::system(line.c_str()), 0) << arguments;
    std::ifstream file(folder_ / "errors");
    return {std::istreambuf_iterator<char>(file), {}};
  }
  // Makes the next reads of a file come from the disk, where the file system allows that.
  void drop_from_memory(const char* name) {
    const int file = ::open((folder_ / name).c_str(), O_RDONLY | O_CLOEXEC);
    ::fsync(file);
    ::posix_fadvise(file, 0, 0, POSIX_FADV_DONTNEED);
    ::close(file);
  }
  void expect_silence(const std::string& threads) {
    EXPECT_EQ(errors_of("generate mesh.ply --triangles 20K --force"), "");
    EXPECT_EQ(errors_of("build mesh.ply -o tree.ptree --force " + threads), "");
    std::ofstream(folder_ / "points.csv") << "x,y,z\n1,2,3\n0,0,0\n100,0,0\n";
    EXPECT_EQ(errors_of("query tree.ptree points.csv " + threads), "");
    EXPECT_EQ(errors_of("query tree.ptree points.csv --contains " + threads), "");
    EXPECT_EQ(errors_of("inspect tree.ptree --levels"), "");
    EXPECT_EQ(errors_of("verify tree.ptree --full"), "");
    EXPECT_EQ(errors_of("touch tree.ptree --seconds 1"), "");
  }

  storage::TemporaryDirectory folder_;
};

TEST_F(SilentSuccess, WithTheThreadsOfTheMachine) { expect_silence(""); }

TEST_F(SilentSuccess, WithMoreThreadsThanProcessors) { expect_silence("--threads 64"); }

TEST_F(SilentSuccess, OnOneProcessor) {
  const OneProcessor one;
  expect_silence("");
  expect_silence("--threads 8");
}

TEST_F(SilentSuccess, UnderAFilterThatEndsUsersOfIoUring) {
  EXPECT_EQ(errors_of("generate mesh.ply --triangles 20K"), "");
  EXPECT_EQ(errors_of("build mesh.ply -o tree.ptree"), "");
  std::ofstream(folder_ / "points.csv") << "x,y,z\n1,2,3\n0,0,0\n100,0,0\n";
  drop_from_memory("tree.ptree");
  const pid_t child = ::fork();
  if (child == 0) {
    if (!forbid_io_uring()) ::_exit(2);
    ::_exit(errors_of("query tree.ptree points.csv --no-io-uring").empty() && !HasFailure() ? 0
                                                                                            : 1);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
}

}  // namespace
}  // namespace planetree::tools
