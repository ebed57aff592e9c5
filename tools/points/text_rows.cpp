#include "tools/points/text_rows.h"

#include <algorithm>
#include <cinttypes>
#include <string_view>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/points/sample_lines.h"

namespace planetree::tools {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

/// The front without its last line, if that may be cut off.
std::string_view whole_lines(std::string_view front, bool is_whole) {
  return is_whole ? front : front.substr(0, front.find_last_of("\r\n") + 1);
}

}  // namespace

Result<TextLines> TextLines::create(InputFile file, std::string_view front, bool is_whole,
                                    const RowShape& shape, const ColumnChoice& choice) {
  const auto layout = find_text_layout(whole_lines(front, is_whole), shape, choice);
  if (!layout) return layout.error();
  if (layout->first_row == TextLayout::kNoRow && !is_whole)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "its first %zu bytes have no line with a %s; give %s, one %s a line",
                      front.size(), shape.noun, shape.joined_names().c_str(), shape.noun);
  return TextLines(std::move(file), shape, *layout);
}

TextLines::TextLines(InputFile file, const RowShape& shape, const TextLayout& layout)
    : lines_(std::move(file)), shape_(&shape), layout_(layout) {
  for (std::size_t i = 0; i < layout.columns.size(); ++i)
    if (layout.columns[i] != kNoColumn) columns_.push_back({layout.columns[i], i});
  std::sort(columns_.begin(), columns_.end(),
            [](const Column& a, const Column& b) { return a.column < b.column; });
}

Result<bool> TextLines::next(std::span<double> numbers) {
  for (;;) {
    const auto found = lines_.next();
    if (!found) return found;
    if (!*found) {
      if (const auto checked = check_count(true); !checked) return checked.error();
      return false;
    }
    std::string_view line = lines_.line();
    if (lines_.number() == 1 && line.starts_with(kByteOrderMark))
      line.remove_prefix(kByteOrderMark.size());
    if (trimmed(line).empty() || is_comment(line) || lines_.number() < layout_.first_row) continue;
    if (const auto parsed = parse_row(line, numbers); !parsed) return parsed.error();
    ++rows_;
    if (const auto checked = check_count(false); !checked) return checked.error();
    return true;
  }
}

Result<void> TextLines::parse_row(std::string_view line, std::span<double> numbers) const {
  LineFields fields(line, layout_.separator);
  std::size_t at = 0;
  if (layout_.is_obj) {
    fields.next();
    if (fields.field() != "v")
      return bad_line("'" + octree::printable(fields.field()) + "' in a list of OBJ vertices");
    at = 1;
  }
  for (const Column& wanted : columns_) {
    bool found = true;
    for (; found && at <= wanted.column; ++at) found = fields.next();
    if (!found) return too_short();
    if (!parse_number(fields.field(), layout_.decimal, numbers[wanted.number]))
      return bad_line("'" + octree::printable(fields.field()) + "' is not a number");
  }
  for (; at < layout_.min_fields; ++at)
    if (!fields.next()) return bad_line("it has fewer columns than the first row");
  return {};
}

Result<void> TextLines::check_count(bool ended) const {
  const std::uint64_t count = layout_.declared_count.value_or(rows_);
  if (ended ? rows_ == count : rows_ <= count) return {};
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "line %" PRIu64 " counts %" PRIu64
                    " %ss, but there are %s; correct or omit the count",
                    layout_.count_line, count, shape_->noun, ended ? "fewer" : "more");
}

Error TextLines::bad_line(const std::string& cause) const {
  const bool has_more = count_fields(lines_.line(), layout_.separator).fields > shape_->required;
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "line %" PRIu64 ": %s; give %s%s, one %s a line", lines_.number(),
                    cause.c_str(), shape_->joined_names().c_str(),
                    has_more ? " first, or --columns" : "", shape_->noun);
}

Error TextLines::too_short() const {
  constexpr const char* kWords[] = {"three", "four", "five", "six", "seven", "eight"};
  return bad_line(std::string("it has fewer than ") + kWords[columns_.size() - 3] + " numbers");
}

}  // namespace planetree::tools
