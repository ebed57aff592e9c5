#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "tools/points/column_names.h"
#include "tools/points/line_fields.h"

namespace planetree::tools {

/// What a line that may be a header says of the columns.
struct TextHeader {
  NamedColumns found = NamedColumns::kNone;
  ColumnList columns;
  std::size_t fields = 0;
  Separator separator = Separator::kComma;  ///< by which the names were found
};

/// Reads a line, which may be a comment, as names of columns: separated like the rows or, if the
/// columns are not found so, in another way.
[[nodiscard]] TextHeader read_header(std::string_view line, Separator separator,
                                     const RowShape& shape, const ColumnChoice& choice);

/// The names in a line, quoted and shortened to fit a message.
[[nodiscard]] std::string shown_names(std::string_view line, Separator separator);

/// Whether a comment lists columns that are not the wanted ones: it has a name for each of the
/// `fields` of a row, where those are more than the required numbers or a name is an axis.
[[nodiscard]] bool lists_other_columns(std::string_view comment, Separator separator,
                                       std::size_t required, std::size_t fields);

}  // namespace planetree::tools
