// write_manual DIRECTORY
//
// Writes the man pages and the completion script of `planetree`. The build runs it.

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>

#include "tools/command.h"
#include "tools/manual/bash_completion.h"
#include "tools/manual/man_page.h"

namespace {

bool write(const std::filesystem::path& path, const std::string& text) {
  std::ofstream file(path, std::ios::binary);
  file << text;
  file.close();
  if (!file) fmt::print(stderr, "write_manual: cannot write {}\n", path.string());
  return !file.fail();
}

}  // namespace

int main(int argc, char** argv) {
  using namespace planetree::tools;
  if (argc != 2) {
    fmt::print(stderr, "usage: write_manual DIRECTORY\n");
    return kCommandLineAtFault;
  }
  const std::filesystem::path folder = argv[1];
  const CommandSummary command = command_summary();
  bool written = write(folder / "planetree.bash", bash_completion(command)) &&
                 write(folder / "planetree.1", man_page(command));
  for (const CommandSummary& subcommand : command.subcommands)
    written = written && write(folder / fmt::format("{}-{}.1", command.name, subcommand.name),
                               man_page(command, subcommand));
  return written ? kDone : kMachineAtFault;
}
