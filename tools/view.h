#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "tools/cli/subcommand.h"
#include "tools/view/view_server.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree view`.
struct ViewArguments {
  std::filesystem::path file;                 ///< of a model or a scene
  std::filesystem::path trace;                ///< of a session to show; empty: none
  std::optional<std::uint64_t> memory_bytes;  ///< empty: what the scene file says, or 256 MiB
  ViewPlace place;
  bool no_open = false;
  bool json = false;
  bool quiet = false;
};

/// Serves the page of a model or a scene until the process gets SIGINT or SIGTERM. Returns the exit
/// status. Blocks these signals in the calling thread meanwhile.
int run_view(const ViewArguments& arguments, Console& console);

/// Adds the subcommand `view` to the command line. If it is given, parsing sets `action` to a call
/// of run_view().
void add_view(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
