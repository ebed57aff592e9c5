#include "tools/points/decimal_mark.h"

#include <algorithm>
#include <cinttypes>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/points/text_layout.h"

namespace planetree::tools {
namespace {

/// Whether the comma may group thousands: one to three digits, but not 0 alone, and three behind.
bool may_group_thousands(std::string_view number) {
  if (number.starts_with('-') || number.starts_with('+')) number.remove_prefix(1);
  const std::size_t comma = number.find(',');
  return comma <= 3 && !number.starts_with('0') && number.size() == comma + 4;
}

class MarkFinder {
 public:
  void add(std::string_view field, std::uint64_t line) {
    const bool has_comma = has_decimal_comma(field);
    double value = 0;
    if (!has_comma && !parse_number(field, DecimalMark::kPoint, value)) return;
    if (has_comma && commas_++ == 0) {
      first_ = field;
      first_line_ = line;
    }
    others_ += has_comma ? 0 : 1;
    has_points_ |= field.find('.') != std::string_view::npos;
    certain_ |= has_comma && !may_group_thousands(field);
  }

  [[nodiscard]] Result<DecimalMark> mark(Separator separator) const {
    if (commas_ == 0) return DecimalMark::kPoint;
    if (has_points_) return refusal("has a comma where other numbers have a point");
    // Between commas, numbers with a comma are in quotes, as grouped thousands often are.
    const bool is_doubtful = others_ > 0 || separator == Separator::kComma;
    if (is_doubtful && !certain_) return refusal("may have a decimal comma or grouped thousands");
    return DecimalMark::kComma;
  }

 private:
  [[nodiscard]] Error refusal(const char* cause) const {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "line %" PRIu64 ": '%s' %s; write all numbers with a decimal point",
                      first_line_, octree::printable(first_).c_str(), cause);
  }

  std::size_t commas_ = 0, others_ = 0;  // numbers with a comma and without
  bool has_points_ = false;
  bool certain_ = false;  // a comma that does not group thousands
  std::string_view first_;
  std::uint64_t first_line_ = 0;
};

}  // namespace

Result<DecimalMark> find_decimal_mark(std::span<const SampleLines::Line> rows, Separator separator,
                                      const ColumnList& columns) {
  MarkFinder marks;
  for (const SampleLines::Line& row : rows) {
    if (is_comment(row.text)) continue;
    LineFields fields(row.text, separator);
    for (std::size_t column = 0; fields.next(); ++column)
      if (std::find(columns.begin(), columns.end(), column) != columns.end())
        marks.add(fields.field(), row.number);
  }
  return marks.mark(separator);
}

}  // namespace planetree::tools
