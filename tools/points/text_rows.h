#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/cli/input_file.h"
#include "tools/points/row_reader.h"
#include "tools/points/text_layout.h"

namespace planetree::tools {

/// The rows of numbers of a text, one a line, in the columns that its layout tells. Other columns,
/// blank lines and comments are ignored.
class TextLines {
 public:
  /// file    whose front() is `front`
  /// errors  those of find_text_layout()
  static Result<TextLines> create(InputFile file, std::string_view front, bool is_whole,
                                  const RowShape& shape, const ColumnChoice& choice);

  /// How many of the shape's numbers have a column or come before one that has.
  [[nodiscard]] std::size_t numbers() const {
    return std::max(layout_.columns.size(), shape_->required);
  }
  /// Reads the next row. Numbers without a column are left as they are. False at the end.
  ///
  /// errors  kBadInput, naming the line; kReadFailed.
  Result<bool> next(std::span<double> numbers);

 private:
  struct Column {
    std::size_t column = 0;
    std::size_t number = 0;
  };

  TextLines(InputFile file, const RowShape& shape, const TextLayout& layout);
  Result<void> parse_row(std::string_view line, std::span<double> numbers) const;
  Result<void> check_count(bool ended) const;
  Error bad_line(const std::string& cause) const;
  Error too_short() const;

  LineReader lines_;
  const RowShape* shape_;
  TextLayout layout_;
  std::vector<Column> columns_;  // from the left to the right
  std::uint64_t rows_ = 0;
};

/// Points, rays or sweeps from text.
template <class Row>
class TextRows final : public RowReader<Row> {
 public:
  TextRows(std::string name, TextLines lines)
      : RowReader<Row>(std::move(name), lines.numbers()), lines_(std::move(lines)) {}

  Result<std::size_t> read(std::span<Row> rows) override {
    if (pending_) return *pending_;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      auto numbers = std::bit_cast<std::array<double, RowReader<Row>::kNumbers>>(Row());
      const auto found = lines_.next(numbers);
      rows[i] = std::bit_cast<Row>(numbers);
      if (found && *found) continue;
      if (!found) pending_ = found.error();
      if (!found && i == 0) return *pending_;
      return i;
    }
    return rows.size();
  }

 private:
  TextLines lines_;
  std::optional<Error> pending_;  // reported after the rows before it
};

}  // namespace planetree::tools
