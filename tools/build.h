#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "octree/builder/tree_builder.h"
#include "tools/cli/subcommand.h"

namespace CLI {
class App;
}

namespace planetree::tools {

struct BuildArguments {
  std::filesystem::path input;
  std::filesystem::path output;
  octree::BuildOptions options;
  bool json = false;
  bool quiet = false;
};

/// Builds the tree and says what it is. Returns the exit status.
int run_build(const BuildArguments& arguments, Console& console);

/// Adds the verb `build` to the command line. If a person gives it, parsing
/// sets `action` to what runs it.
void add_build(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
