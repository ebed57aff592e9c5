#include "tools/points/sample_lines.h"

#include <algorithm>
#include <utility>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/points/point_number.h"
#include "tools/points/text_layout.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kMaxRows = 200;
constexpr std::size_t kMaxCountDigits = 18;

/// How many lines have so many numbers and, where that says nothing, so many fields.
std::pair<std::size_t, std::size_t> rows_of(const std::vector<SampleLines::Line>& lines,
                                            Separator separator, std::size_t wanted) {
  std::pair<std::size_t, std::size_t> rows;
  for (const SampleLines::Line& line : lines) {
    if (is_comment(line.text)) continue;
    const FieldCounts counts = count_fields(line.text, separator);
    rows.first += counts.numbers >= wanted ? 1 : 0;
    rows.second += counts.fields >= wanted ? 1 : 0;
  }
  return rows;
}

}  // namespace

SampleLines::SampleLines(std::string_view front) {
  octree::LineScanner scanner(front, octree::text_begin(front));
  for (std::size_t rows = 0; rows < kMaxRows && scanner.next_filled();) {
    const std::string_view text = scanner.line();
    lines_.push_back({text, scanner.position().line});
    rows += is_comment(text) ? 0 : 1;
  }
}

Separator SampleLines::separator(std::size_t numbers) const {
  constexpr std::size_t kMinNumbers = 3;
  Separator best = Separator::kComma;
  std::pair<std::size_t, std::size_t> most;
  // Rows that are too short are told as such if their separator is found by fewer numbers.
  for (; numbers >= kMinNumbers && most == decltype(most)(); --numbers) {
    for (const Separator separator : kSeparators) {
      const auto rows = rows_of(lines_, separator, numbers);
      if (rows > most) best = separator;
      most = std::max(most, rows);
    }
  }
  return best;
}

FieldCounts count_fields(std::string_view line, Separator separator) {
  FieldCounts counts;
  for (LineFields fields(line, separator); fields.next(); ++counts.fields)
    counts.numbers += is_number(fields.field()) ? 1 : 0;
  return counts;
}

bool is_number(std::string_view field) {
  double value = 0;
  return parse_number(field, DecimalMark::kPoint, value) || has_decimal_comma(field);
}

bool is_count(std::string_view line) {
  line = trimmed(line);
  return !line.empty() && line.size() <= kMaxCountDigits &&
         std::all_of(line.begin(), line.end(), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace planetree::tools
