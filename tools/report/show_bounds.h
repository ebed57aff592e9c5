#pragma once

#include <cstdint>
#include <filesystem>

#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// Arguments of `planetree inspect --export-bounds`.
struct BoundsArguments {
  std::filesystem::path file, output;  ///< without an output, bounds are not exported
  std::uint64_t level = 0;
  bool may_replace = false;
  bool json = false;
  bool quiet = false;
};

/// A complaint if the extension of an output is not that of a PLY, else nothing.
[[nodiscard]] std::string bounds_complaint(const std::string& path);

/// Exports the bounds of a level and reports counts. Returns the exit status.
int show_bounds(const BoundsArguments& arguments, Console& console);

}  // namespace planetree::tools
