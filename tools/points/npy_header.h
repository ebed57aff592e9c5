#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include "octree/builder/mesh/stream/scalar_type.h"
#include "planetree/error.h"
#include "tools/points/row_shape.h"

namespace planetree::tools {

/// The header of a NumPy array file (.npy): what its numbers are and how many rows of them follow.
///
/// source  numpy.lib.format, versions 1.0 to 3.0
struct NpyHeader {
  octree::ScalarType type = octree::ScalarType::kFloat64;
  bool swap = false;        ///< whether the file has the other byte order
  std::size_t bytes = 0;    ///< length of the header
  std::uint64_t rows = 0;   ///< product of all lengths but the last
  std::size_t numbers = 0;  ///< of a row: the last length

  /// Bytes of a row.
  [[nodiscard]] std::size_t row_bytes() const {
    return numbers * static_cast<std::size_t>(octree::size_bytes(type));
  }
};

/// Whether a file begins as a NumPy array does.
[[nodiscard]] bool is_npy(std::string_view front) noexcept;

/// Reads a header and checks that the array has rows of a shape.
///
/// front   the first bytes of the file, all of the header among them
/// errors  kBadInput: the header is damaged, or the array has no such rows
Result<NpyHeader> parse_npy_header(std::string_view front, const RowShape& shape);

}  // namespace planetree::tools
