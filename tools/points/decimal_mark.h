#pragma once

#include <span>

#include "planetree/error.h"
#include "tools/points/column_names.h"
#include "tools/points/point_number.h"
#include "tools/points/sample_lines.h"

namespace planetree::tools {

/// Finds the decimal mark of the wanted numbers in the first rows. It is a comma only if that
/// leaves no doubt: none of them has a point, and not all commas may group thousands.
///
/// errors  kBadInput, naming the line
Result<DecimalMark> find_decimal_mark(std::span<const SampleLines::Line> rows, Separator separator,
                                      const ColumnList& columns);

}  // namespace planetree::tools
