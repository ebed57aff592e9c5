#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "planetree/types.h"
#include "tools/cli/report_page.h"
#include "tools/points/column_names.h"

namespace planetree::tools {

/// Arguments of `planetree thickness`.
struct ThicknessArguments {
  std::filesystem::path file;
  std::filesystem::path points;  ///< empty: the middles of the model's triangles
  ColumnChoice columns;          ///< of a text of points
  std::filesystem::path output;  ///< coloured points; empty: none
  std::filesystem::path rows;    ///< CSV; empty: none
  std::optional<double> max_thickness;
  std::optional<double> thin;     ///< count what is thinner
  std::optional<double> spacing;  ///< longest edge of the triangles' parts; empty: by the model
  std::uint64_t every = 1;        ///< measure at one of so many parts
  double min_angle_degrees = 30;
  SideRule side_rule = SideRule::kOfFile;
  std::uint64_t memory_bytes = std::uint64_t{256} << 20;
  std::uint64_t threads = 0;  ///< batch threads; 0: one for each processor
  PageChoice page;            ///< page to write; its `force` is for all files
  bool json = false;
  bool quiet = false;
};

/// The command that measures the same and writes the same files again, as typed in a shell. Options
/// that have their defaults are left out.
std::string thickness_command(const ThicknessArguments& arguments);

}  // namespace planetree::tools
