#include <csignal>
#include <cstdio>

#include "tools/command.h"

int main(int argc, char** argv) {
  // A closed pipe must not end the process in the middle of a file: writing fails instead.
  std::signal(SIGPIPE, SIG_IGN);
  // A limit of the file size becomes an error to report, like a full device.
  std::signal(SIGXFSZ, SIG_IGN);
  planetree::tools::Console console(stdin, stdout, stderr);
  return planetree::tools::run_command(argc, argv, console);
}
