#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "planetree/types.h"
#include "tools/cli/report_page.h"
#include "tools/mesh/input_kind.h"
#include "tools/points/column_names.h"

namespace planetree::tools {

/// Arguments of `planetree compare`.
struct CompareArguments {
  std::filesystem::path file;
  std::filesystem::path other;    ///< points or a mesh; "-" is standard input
  std::optional<InputKind> kind;  ///< of `other`; empty: as its content tells
  ColumnChoice columns;           ///< of a text of points
  std::filesystem::path output;   ///< coloured points; empty: none
  std::optional<double> tolerance;
  std::optional<double> spacing;          ///< longest edge of a mesh's parts; empty: by the model
  std::optional<double> hausdorff_error;  ///< of a mesh; empty: as HausdorffGoal
  std::uint64_t max_splits = 50'000'000;  ///< of triangles, for the greatest distance
  std::optional<double> reach;            ///< deviation of the darkest colours
  double max_distance = std::numeric_limits<double>::infinity();
  bool is_unsigned = false;  ///< leave sides out
  SideRule side_rule = SideRule::kOfFile;
  std::uint64_t memory_bytes = std::uint64_t{256} << 20;
  std::uint64_t threads = 0;  ///< batch threads; 0: one for each processor
  PageChoice page;            ///< page to write; its `force` is for the output too
  bool json = false;
  bool quiet = false;
};

/// The command that compares the same and writes the same files again, as typed in a shell. Options
/// that have their defaults are left out.
std::string compare_command(const CompareArguments& arguments);

}  // namespace planetree::tools
