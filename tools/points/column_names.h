#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"
#include "tools/points/row_shape.h"

namespace planetree::tools {

/// Indices of the columns of x, y and z, from 0.
using AxisColumns = std::array<std::size_t, 3>;

/// Indices of the columns of a row's numbers, from 0, in the order of its shape. kNoColumn, or no
/// entry at the end, is for optional numbers without a column.
using ColumnList = std::vector<std::size_t>;
inline constexpr std::size_t kNoColumn = ~std::size_t{0};

/// The columns of a row's numbers as typed, each by its name or its number from 1. Empty: by the
/// names of a header, or the first ones.
struct ColumnChoice {
  std::vector<std::string> columns;

  /// errors  kBadArgument: not as many different columns as the shape has numbers; optional ones
  ///         may be left out at the end.
  static Result<ColumnChoice> parse(std::string_view text, const RowShape& shape = kPointShape);
  [[nodiscard]] bool empty() const { return columns.empty(); }
  /// Whether all are numbers, so that no names are needed.
  [[nodiscard]] bool is_numeric() const;
};

/// What a list of names says of the wanted columns.
enum class NamedColumns : std::uint8_t { kNone, kOnce, kAmbiguous };

/// Finds x, y and z by the names that programs give them, in any case: "X [m]", "Point_X", "pos.x",
/// "Points:0", "xcoord"; "easting", "northing" and "height". Units do not matter. The three are
/// found together: names of one kind. Plain "x", "y" and "z" precede all others.
[[nodiscard]] NamedColumns find_axes(const std::vector<std::string_view>& names,
                                     AxisColumns& columns);

/// Finds the columns named as in the shape, the optional ones if they are there. A name is compared
/// in any case, as it is or without its unit.
[[nodiscard]] NamedColumns find_named(const RowShape& shape,
                                      const std::vector<std::string_view>& names,
                                      ColumnList& columns);

/// Finds the chosen columns. A name is compared as by find_named().
[[nodiscard]] NamedColumns find_chosen(const ColumnChoice& choice,
                                       const std::vector<std::string_view>& names,
                                       ColumnList& columns);

}  // namespace planetree::tools
