#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace planetree::tools {

/// What the numbers of a column are. All are little-endian.
enum class NumberType : std::uint8_t { kFloat64, kInt64, kUint8, kBool };

constexpr std::size_t size_bytes(NumberType type) noexcept {
  return type == NumberType::kFloat64 || type == NumberType::kInt64 ? 8 : 1;
}

/// A column of a table of numbers: a number a row, or a vector of named numbers.
struct Column {
  std::string name;
  NumberType type = NumberType::kFloat64;
  std::vector<std::string> parts = {};  ///< names of the numbers of a vector; empty: one number

  [[nodiscard]] std::size_t count() const noexcept { return parts.empty() ? 1 : parts.size(); }
  /// Bytes of a row.
  [[nodiscard]] std::size_t bytes() const noexcept { return count() * size_bytes(type); }
};

/// Bytes of a row of all columns, one behind the other without gaps.
[[nodiscard]] inline std::size_t row_bytes(const std::vector<Column>& columns) noexcept {
  std::size_t bytes = 0;
  for (const Column& column : columns) bytes += column.bytes();
  return bytes;
}

}  // namespace planetree::tools
