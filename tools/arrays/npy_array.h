#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/arrays/column.h"

namespace planetree::tools {

/// The header of a NumPy array file (.npy) of rows, which follow it without gaps. Each number of a
/// column is a field of the array's structured type. The header has the same length for any number
/// of rows, so that it can be written first, and again once the number is known. It is a multiple
/// of 64 bytes long.
///
/// source  numpy.lib.format, version 1.0
[[nodiscard]] std::string npy_header_text(const std::vector<Column>& columns, std::uint64_t rows);

}  // namespace planetree::tools
