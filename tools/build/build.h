#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "planetree/build.h"
#include "tools/cli/subcommand.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree build`.
struct BuildArguments {
  std::vector<std::filesystem::path> inputs;  ///< mesh files, which are one mesh together
  std::filesystem::path output;
  BuildOptions options;
  bool json = false;
  bool quiet = false;
};

/// Builds the file and reports its contents. Returns the exit status.
int run_build(const BuildArguments& arguments, Console& console);

/// Adds the subcommand `build` to the command line. If given, parsing sets `action` to a call of
/// run_build().
void add_build(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
