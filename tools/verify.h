#pragma once

#include <filesystem>
#include <functional>

#include "tools/cli/subcommand.h"

namespace CLI {
class App;
}

namespace planetree::tools {

struct VerifyArguments {
  std::filesystem::path file;
  bool full = false;
  bool json = false;
  bool quiet = false;
};

/// Lists every issue of a file. Returns the exit status: 1 if there is any.
int run_verify(const VerifyArguments& arguments, Console& console);

/// Adds the verb `verify` to the command line. If a person gives it, parsing
/// sets `action` to what runs it.
void add_verify(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
