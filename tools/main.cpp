#include <csignal>
#include <cstdio>

#include "tools/command.h"

int main(int argc, char** argv) {
  // A reader of our output that has seen enough is no reason to die half-way
  // through a file: writing to it fails instead.
  std::signal(SIGPIPE, SIG_IGN);
  // A limit of file sizes is an error to report, as a full device is.
  std::signal(SIGXFSZ, SIG_IGN);
  planetree::tools::Console console(stdin, stdout, stderr);
  return planetree::tools::run_command(argc, argv, console);
}
