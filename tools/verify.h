#pragma once

#include <filesystem>
#include <functional>

#include "tools/cli/open_model.h"
#include "tools/cli/subcommand.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree verify`.
struct VerifyArguments {
  std::filesystem::path file;
  bool full = false;
  SourceChoice source;  ///< for a URL or a set
  bool json = false;
  bool quiet = false;
};

/// Lists the issues of a file. Returns the exit status, 1 if there are issues.
int run_verify(const VerifyArguments& arguments, Console& console);

/// Adds the subcommand `verify` to the command line. If it is given, parsing sets `action` to a
/// call of run_verify().
void add_verify(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
