#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "planetree/layers.h"
#include "planetree/types.h"
#include "tools/cli/report_page.h"

namespace planetree::tools {

/// Arguments of `planetree trade`.
struct TradeArguments {
  std::filesystem::path file;
  std::filesystem::path points;  ///< file of query points; empty: they are made
  std::uint64_t count = 2000;    ///< query points of each workload
  std::uint64_t memory_bytes = std::uint64_t{256} << 20;
  std::uint32_t layers = kAllLayers;  ///< layers to open
  std::uint32_t parts = kAllParts;    ///< parts to ask for
  PageChoice page;                    ///< page to write
  bool json = false;
  bool quiet = false;
};

/// The command that measures the same and writes the page again, as typed in a shell. Options that
/// have their defaults are left out.
std::string trade_command(const TradeArguments& arguments);

}  // namespace planetree::tools
