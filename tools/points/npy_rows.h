#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cinttypes>
#include <cstdint>
#include <string>
#include <vector>

#include "tools/cli/input_file.h"
#include "tools/points/npy_header.h"
#include "tools/points/row_reader.h"

namespace planetree::tools {

/// Rows of a NumPy array, as parse_npy_header() describes them.
template <class Row>
class NpyRows final : public RowReader<Row> {
 public:
  /// file  behind the header
  NpyRows(std::string name, InputFile file, const NpyHeader& header)
      : RowReader<Row>(std::move(name), header.numbers),
        file_(std::move(file)),
        header_(header),
        bytes_(kChunkRows * header.row_bytes()) {}

  Result<std::size_t> read(std::span<Row> rows) override {
    if (is_cut_) return cut_off();
    const std::uint64_t left = header_.rows - rows_read_;
    const auto wanted =
        static_cast<std::size_t>(std::min<std::uint64_t>({rows.size(), kChunkRows, left}));
    if (wanted == 0) return std::size_t{0};
    const auto bytes = file_.read(std::span(bytes_).first(wanted * header_.row_bytes()));
    if (!bytes) return bytes.error();
    const std::size_t count = *bytes / header_.row_bytes();
    for (std::size_t i = 0; i < count; ++i) rows[i] = row_at(i);
    rows_read_ += count;
    is_cut_ = count < wanted;
    if (count == 0) return cut_off();
    return count;
  }

 private:
  static constexpr std::size_t kChunkRows = 4096;

  Row row_at(std::size_t i) const {
    // Optional numbers keep their defaults.
    auto numbers = std::bit_cast<std::array<double, RowReader<Row>::kNumbers>>(Row{});
    const std::size_t step = header_.row_bytes() / header_.numbers;
    for (std::size_t k = 0; k < header_.numbers; ++k)
      numbers[k] = octree::load_real(
          header_.type, bytes_.data() + i * header_.row_bytes() + k * step, header_.swap);
    return std::bit_cast<Row>(numbers);
  }
  Error cut_off() const {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "the NumPy array ends after %" PRIu64 " of %" PRIu64
                      " rows; copy or save it again",
                      rows_read_, header_.rows);
  }

  InputFile file_;
  const NpyHeader header_;
  std::vector<std::byte> bytes_;
  std::uint64_t rows_read_ = 0;
  bool is_cut_ = false;
};

}  // namespace planetree::tools
