#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/points/line_fields.h"

namespace planetree::tools {

/// The first lines of a text of points that are not blank, by which its layout is decided.
class SampleLines {
 public:
  struct Line {
    std::string_view text;
    std::uint64_t number = 0;
  };

  /// front  must outlive this
  explicit SampleLines(std::string_view front);

  [[nodiscard]] const std::vector<Line>& lines() const { return lines_; }
  /// The separator by which most lines have so many numbers. Among equals, one that leaves fields
  /// empty rather than one that skips them.
  [[nodiscard]] Separator separator(std::size_t numbers) const;

 private:
  std::vector<Line> lines_;
};

/// What the fields of a line are.
struct FieldCounts {
  std::size_t fields = 0;
  std::size_t numbers = 0;
};
[[nodiscard]] FieldCounts count_fields(std::string_view line, Separator separator);

/// Whether a field is a number with either decimal mark.
[[nodiscard]] bool is_number(std::string_view field);

/// Whether a line is one whole number alone.
[[nodiscard]] bool is_count(std::string_view line);

}  // namespace planetree::tools
