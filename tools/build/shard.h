#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "planetree/build.h"
#include "tools/cli/subcommand.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree shard`.
struct ShardArguments {
  std::string step;                           ///< plan, map, reduce or merge
  std::vector<std::filesystem::path> meshes;  ///< of plan
  std::filesystem::path job;                  ///< of the other steps
  std::filesystem::path output;               ///< the job of plan; the file of merge
  std::uint64_t shards = 0;                   ///< of plan
  std::optional<std::uint32_t> shard;         ///< of map and reduce
  BuildOptions options;
  bool json = false;
  bool quiet = false;
};

/// Runs one step of a sharded build and reports it. Returns the exit status.
int run_shard(const ShardArguments& arguments, Console& console);

/// Adds the subcommand `shard` to the command line. If given, parsing sets `action` to a call of
/// run_shard().
void add_shard(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
