#include "tools/points/csv_points.h"

#include <algorithm>
#include <cinttypes>
#include <string_view>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::tools {
namespace {

constexpr std::string_view kAxes[] = {"x", "y", "z"};

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

/// Removes the first field from `rest`. False if there is none.
bool take_field(std::string_view& rest, std::string_view& field) {
  if (rest.data() == nullptr) return false;
  const std::size_t comma = rest.find(',');
  field = trimmed(rest.substr(0, comma));
  if (field.size() >= 2 && field.front() == '"' && field.back() == '"')
    field = field.substr(1, field.size() - 2);
  rest = comma == std::string_view::npos ? std::string_view() : rest.substr(comma + 1);
  return true;
}

}  // namespace

Result<std::size_t> CsvPoints::read(std::span<Vec3> points) {
  if (pending_) return *pending_;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto found = next_point(points[i]);
    if (found && *found) continue;
    if (!found && i == 0) return found.error();
    if (!found) pending_ = found.error();
    return i;
  }
  return points.size();
}

Result<bool> CsvPoints::next_point(Vec3& point) {
  std::string_view line;
  for (;;) {
    const auto found = lines_.next();
    if (!found || !*found) return found;
    line = lines_.line();
    if (lines_.number() == 1 && line.starts_with("\xef\xbb\xbf")) line.remove_prefix(3);
    if (trimmed(line).empty()) continue;
    const bool first = !started_;
    started_ = true;
    if (!first || !take_header(line)) break;
  }
  double* const values[] = {&point.x, &point.y, &point.z};
  std::size_t found = 0;
  std::string_view field;
  for (std::size_t column = 0; found < 3 && take_field(line, field); ++column) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (columns_[axis] != column) continue;
      if (!octree::parse_real(field, *values[axis]))
        return bad_line("'" + octree::printable(field) + "' is not a number");
      ++found;
    }
  }
  if (found < 3) return bad_line("it has fewer than three numbers");
  return true;
}

Error CsvPoints::bad_line(const std::string& cause) const {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "line %" PRIu64 ": %s; give x,y,z, one point a line", lines_.number(),
                    cause.c_str());
}

/// Reads the columns of x, y and z from a header. A header is a first line without a number among
/// its first three fields. False if the line is not one.
bool CsvPoints::take_header(std::string_view line) {
  std::array<std::size_t, 3> named = {};
  std::size_t found = 0;
  std::string_view field;
  for (std::size_t column = 0; take_field(line, field); ++column) {
    double value = 0;
    if (column < 3 && octree::parse_real(field, value)) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!octree::is_same_word(field, kAxes[axis])) continue;
      named[axis] = column;
      ++found;
    }
  }
  if (found == 3) columns_ = named;
  return true;
}

}  // namespace planetree::tools
