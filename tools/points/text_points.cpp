#include "tools/points/text_points.h"

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

Result<std::unique_ptr<PointReader>> TextPoints::create(std::string name, InputFile file,
                                                        std::string_view front, bool is_whole,
                                                        const ColumnChoice& choice) {
  const auto layout = find_text_layout(whole_lines(front, is_whole), choice);
  if (!layout) return layout.error();
  if (layout->first_row == TextLayout::kNoRow && !is_whole)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "its first %zu bytes have no line with a point; give x,y,z, one point a line",
                      front.size());
  return std::unique_ptr<PointReader>(new TextPoints(std::move(name), std::move(file), *layout));
}

TextPoints::TextPoints(std::string name, InputFile file, const TextLayout& layout)
    : PointReader(std::move(name)), lines_(std::move(file)), layout_(layout) {
  for (std::size_t axis = 0; axis < 3; ++axis) columns_[axis] = {layout.columns[axis], axis};
  std::sort(columns_.begin(), columns_.end(),
            [](const Column& a, const Column& b) { return a.column < b.column; });
}

Result<std::size_t> TextPoints::read(std::span<Vec3> points) {
  if (pending_) return *pending_;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto found = next_point(points[i]);
    if (found && *found) continue;
    if (!found) pending_ = found.error();
    if (!found && i == 0) return *pending_;
    return i;
  }
  return points.size();
}

Result<bool> TextPoints::next_point(Vec3& point) {
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
    if (const auto parsed = parse_row(line, point); !parsed) return parsed.error();
    ++rows_;
    if (const auto checked = check_count(false); !checked) return checked.error();
    return true;
  }
}

Result<void> TextPoints::parse_row(std::string_view line, Vec3& point) const {
  double* const values[] = {&point.x, &point.y, &point.z};
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
    if (!found) return bad_line("it has fewer than three numbers");
    if (!parse_number(fields.field(), layout_.decimal, *values[wanted.axis]))
      return bad_line("'" + octree::printable(fields.field()) + "' is not a number");
  }
  for (; at < layout_.min_fields; ++at)
    if (!fields.next()) return bad_line("it has fewer columns than the first row");
  return {};
}

Result<void> TextPoints::check_count(bool ended) const {
  const std::uint64_t count = layout_.declared_count.value_or(rows_);
  if (ended ? rows_ == count : rows_ <= count) return {};
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "line %" PRIu64 " counts %" PRIu64
                    " points, but there are %s; correct or omit "
                    "the count",
                    layout_.count_line, count, ended ? "fewer" : "more");
}

Error TextPoints::bad_line(const std::string& cause) const {
  const bool has_more = count_fields(lines_.line(), layout_.separator).fields > 3;
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "line %" PRIu64 ": %s; give x,y,z%s, one point a line", lines_.number(),
                    cause.c_str(), has_more ? " first, or --columns" : "");
}

}  // namespace planetree::tools
