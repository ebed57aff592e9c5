#pragma once

#include <span>

#include "planetree/error.h"
#include "tools/points/column_names.h"
#include "tools/points/point_number.h"
#include "tools/points/sample_lines.h"

namespace planetree::tools {

/// Finds the decimal mark of the coordinates in the first rows. It is a comma only if that leaves
/// no doubt: no coordinate has a point, and not all commas may group thousands.
///
/// errors  kBadInput, naming the line
Result<DecimalMark> find_decimal_mark(std::span<const SampleLines::Line> rows, Separator separator,
                                      const AxisColumns& columns);

}  // namespace planetree::tools
