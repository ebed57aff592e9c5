// Kills many builds and checks what each leaves behind.

#include <cstdio>
#include <cstdlib>

#include "tests/tools/cli/killed_builds.h"

int main(int argc, char** argv) {
  using planetree::tools::KilledBuilds;
  const unsigned count = argc > 1 ? static_cast<unsigned>(std::strtoul(argv[1], nullptr, 10)) : 200;
  KilledBuilds builds(PLANETREE_COMMAND, 2);
  if (!builds.has_unnamed_files()) {
    std::fprintf(stderr, "check_kills: %s has no files without names; set TMPDIR to one that has\n",
                 std::filesystem::temp_directory_path().c_str());
    return 2;
  }
  if (const std::string wrong = builds.prepare("200K"); !wrong.empty()) {
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
      "%u builds: %u killed, the others done before; %u whole files, %u as before; %u killed "
      "between two names; %u gone on with by --resume; %u wrong\n",
      count, killed, complete, count - complete, temporary_names, resumed, wrong);
  return wrong > 0 || killed == 0 ? 1 : 0;
}
