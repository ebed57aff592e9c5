#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "planetree/error.h"
#include "tools/points/column_names.h"
#include "tools/points/line_fields.h"
#include "tools/points/point_number.h"

namespace planetree::tools {

/// How a text file of points, rays or sweeps is written. It is decided once, from the first lines.
struct TextLayout {
  static constexpr std::uint64_t kNoRow = ~std::uint64_t{0};

  Separator separator = Separator::kComma;
  DecimalMark decimal = DecimalMark::kPoint;
  ColumnList columns;
  /// Number of the line with the first row, from 1. What precedes it is a header, a title, a
  /// comment or a count.
  std::uint64_t first_row = kNoRow;
  /// The number of fields that a row has at least, if that is known.
  std::size_t min_fields = 0;
  /// The number of rows that the file declares, in this line.
  std::optional<std::uint64_t> declared_count;
  std::uint64_t count_line = 0;
  /// The points are the vertices of an OBJ file: lines that begin with v.
  bool is_obj = false;
};

/// Whether a line begins with "#" or "//", behind blanks or not.
[[nodiscard]] inline bool is_comment(std::string_view line) {
  const std::size_t begin = line.find_first_not_of(" \t");
  return begin != std::string_view::npos && (line[begin] == '#' || line.substr(begin, 2) == "//");
}

/// Finds the layout of a text from its front.
///
/// front     without a line that is cut off
/// choice    the columns as typed, if they are
/// errors    kBadInput: a header without the required names or without the chosen columns, or
///           numbers that may be read in two ways
Result<TextLayout> find_text_layout(std::string_view front, const RowShape& shape,
                                    const ColumnChoice& choice);

}  // namespace planetree::tools
