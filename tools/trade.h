#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "tools/cli/subcommand.h"

namespace CLI {
class App;
}

namespace planetree::tools {

/// Arguments of `planetree trade`.
struct TradeArguments {
  std::filesystem::path file;
  std::filesystem::path points;  ///< file of query points; empty: they are made
  std::uint64_t count = 2000;    ///< query points of each workload
  std::uint64_t memory_bytes = std::uint64_t{256} << 20;
  bool json = false;
  bool quiet = false;
};

/// Measures what the options of a query trade accuracy for. Returns the exit status.
int run_trade(const TradeArguments& arguments, Console& console);

/// Adds the subcommand `trade` to the command line. If given, parsing sets `action` to a call of
/// run_trade().
void add_trade(CLI::App& app, Console& console, std::function<int()>& action);

}  // namespace planetree::tools
