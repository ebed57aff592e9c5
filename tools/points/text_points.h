#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>

#include "tools/cli/input_file.h"
#include "tools/points/point_reader.h"
#include "tools/points/text_layout.h"

namespace planetree::tools {

/// Points from text, one a line, in the columns that its layout tells. Other columns, blank lines
/// and comments are ignored.
class TextPoints final : public PointReader {
 public:
  /// file    whose front() is `front`
  /// errors  those of find_text_layout()
  static Result<std::unique_ptr<PointReader>> create(std::string name, InputFile file,
                                                     std::string_view front, bool is_whole,
                                                     const ColumnChoice& choice);

  Result<std::size_t> read(std::span<Vec3> points) override;

 private:
  struct Column {
    std::size_t column = 0;
    std::size_t axis = 0;
  };

  TextPoints(std::string name, InputFile file, const TextLayout& layout);
  Result<bool> next_point(Vec3& point);
  Result<void> parse_row(std::string_view line, Vec3& point) const;
  Result<void> check_count(bool ended) const;
  Error bad_line(const std::string& cause) const;

  LineReader lines_;
  TextLayout layout_;
  std::array<Column, 3> columns_{};  // from the left to the right
  std::uint64_t rows_ = 0;
  std::optional<Error> pending_;  // reported after the points before it
};

}  // namespace planetree::tools
