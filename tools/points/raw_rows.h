#pragma once

#include <bit>
#include <cstdint>
#include <string>
#include <type_traits>

#include "tools/cli/input_file.h"
#include "tools/points/row_reader.h"
#include "tools/points/row_shape.h"

namespace planetree::tools {

/// Rows as little-endian float64 values without gaps: all numbers of a row, in the order of its
/// shape.
template <class Row>
class RawRows final : public RowReader<Row> {
 public:
  RawRows(std::string name, InputFile file, const RowShape& shape)
      : RowReader<Row>(std::move(name)), file_(std::move(file)), shape_(shape) {}

  Result<std::size_t> read(std::span<Row> rows) override {
    if (odd_bytes_ == 0) {
      const auto bytes = file_.read(std::as_writable_bytes(rows));
      if (!bytes) return bytes.error();
      const std::size_t count = *bytes / sizeof(Row);
      odd_bytes_ = *bytes % sizeof(Row);
      offset_ += count * sizeof(Row);
      if (count > 0 || odd_bytes_ == 0) return count;
    }
    return make_error(ErrorCode::kBadInput, Error::kNowhere, offset_,
                      "the file ends %zu bytes into a %s of %zu bytes; write whole %ss", odd_bytes_,
                      shape_.noun, sizeof(Row), shape_.noun);
  }

 private:
  static_assert(std::endian::native == std::endian::little && std::is_trivially_copyable_v<Row> &&
                    sizeof(Row) == RowReader<Row>::kNumbers * sizeof(double),
                "the file's bytes are read in place");

  InputFile file_;
  const RowShape& shape_;
  std::uint64_t offset_ = 0;
  std::size_t odd_bytes_ = 0;  // bytes of an incomplete last row
};

}  // namespace planetree::tools
