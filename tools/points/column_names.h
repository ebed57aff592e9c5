#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"

namespace planetree::tools {

/// Indices of the columns of x, y and z, from 0.
using AxisColumns = std::array<std::size_t, 3>;

/// The columns of x, y and z as typed, each by its name or its number from 1. Empty: by the names
/// of a header, or the first three.
struct ColumnChoice {
  std::vector<std::string> columns;

  /// errors  kBadArgument: not three different columns.
  static Result<ColumnChoice> parse(std::string_view text);
  [[nodiscard]] bool empty() const { return columns.empty(); }
  /// Whether all three are numbers, so that no names are needed.
  [[nodiscard]] bool is_numeric() const;
};

/// What a list of names says of x, y and z.
enum class NamedAxes : std::uint8_t { kNone, kOnce, kAmbiguous };

/// Finds x, y and z by the names that programs give them, in any case: "X [m]", "Point_X", "pos.x",
/// "Points:0", "xcoord"; "easting", "northing" and "height". Units do not matter. The three are
/// found together: names of one kind. Plain "x", "y" and "z" precede all others.
[[nodiscard]] NamedAxes find_axes(const std::vector<std::string_view>& names, AxisColumns& columns);

/// Finds the chosen columns. A name is compared in any case, as it is or without its unit.
[[nodiscard]] NamedAxes find_chosen(const ColumnChoice& choice,
                                    const std::vector<std::string_view>& names,
                                    AxisColumns& columns);

}  // namespace planetree::tools
