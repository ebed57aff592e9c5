// Kills many builds and checks what each leaves behind.
// usage: check_kills [COUNT]
// Kills COUNT builds, 200 by default: half of them of a closed model, half of one with holes. Exit
// status 1 if anything is wrong.

#include <cstdio>
#include <cstdlib>

#include "tests/tools/cli/killed_builds.h"

namespace {

using planetree::tools::KilledBuilds;

int kill_builds(const char* holes, unsigned count) {
  KilledBuilds builds(PLANETREE_COMMAND, 2);
  if (!builds.has_unnamed_files()) {
    std::fprintf(stderr, "check_kills: %s has no files without names; set TMPDIR to one that has\n",
                 std::filesystem::temp_directory_path().c_str());
    return 2;
  }
  if (const std::string wrong = builds.prepare("200K", holes); !wrong.empty()) {
    std::fprintf(stderr, "check_kills: %s\n", wrong.c_str());
    return 2;
  }
  unsigned killed = 0, complete = 0, temporary_names = 0, resumed = 0, wrong = 0;
  for (unsigned i = 0; i < count; ++i) {
    const KilledBuilds::Left left = builds.kill_one(i, count, i / 2 % 2 == 0);
    killed += left.killed ? 1 : 0;
    complete += left.complete ? 1 : 0;
    temporary_names += left.temporary_name ? 1 : 0;
    resumed += left.work ? 1 : 0;
    if (left.wrong.empty()) continue;
    ++wrong;
    std::printf("%s\n", left.wrong.c_str());
  }
  std::printf(
      "%s holes: %u builds: %u killed, the others done before; %u whole files, %u as before; %u "
      "killed between two names; %u gone on with by --resume; %u wrong\n",
      holes, count, killed, complete, count - complete, temporary_names, resumed, wrong);
  return wrong > 0 || killed == 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const unsigned count = argc > 1 ? static_cast<unsigned>(std::strtoul(argv[1], nullptr, 10)) : 200;
  for (const char* holes : {"0", "1000"})
    if (const int status = kill_builds(holes, (count + 1) / 2); status != 0) return status;
  return 0;
}
