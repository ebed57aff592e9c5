#include "tools/points/text_header.h"

#include <algorithm>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/points/column_words.h"
#include "tools/points/point_number.h"
#include "tools/points/text_layout.h"

namespace planetree::tools {
namespace {

/// The text of a comment, without a word in front such as "columns:".
std::string_view without_comment_mark(std::string_view line) {
  if (!is_comment(line)) return line;
  const std::size_t begin = line.find_first_not_of("#/ \t");
  if (begin == std::string_view::npos) return {};
  line.remove_prefix(begin);
  std::string_view rest = line;
  return octree::take_word(rest).ends_with(':') ? trimmed(rest) : line;
}

std::vector<std::string_view> names_in(std::string_view line, Separator separator) {
  std::vector<std::string_view> names;
  for (LineFields fields(without_comment_mark(line), separator); fields.next();)
    names.push_back(fields.field());
  return names;
}

NamedColumns find_columns(const RowShape& shape, const std::vector<std::string_view>& names,
                          ColumnList& columns) {
  if (shape.kind != RowKind::kPoint) return find_named(shape, names, columns);
  AxisColumns axes{};
  const NamedColumns found = find_axes(names, axes);
  columns.assign(axes.begin(), axes.end());
  return found;
}

TextHeader read_as(std::string_view line, Separator separator, const RowShape& shape,
                   const ColumnChoice& choice) {
  // "X [m]" is one name also where blanks separate.
  const std::string without_units = without_brackets(line);
  const bool has_units = separator == Separator::kBlank && !trimmed(without_units).empty();
  const auto names = names_in(has_units ? without_units : line, separator);
  TextHeader header;
  header.fields = names.size();
  header.separator = separator;
  header.found = choice.empty() ? find_columns(shape, names, header.columns)
                                : find_chosen(choice, names, header.columns);
  return header;
}

bool is_axis(std::string_view name) {
  const auto words = words_of(name);
  return words.size() == 1 && axis_name(words);
}

}  // namespace

TextHeader read_header(std::string_view line, Separator separator, const RowShape& shape,
                       const ColumnChoice& choice) {
  const TextHeader header = read_as(line, separator, shape, choice);
  if (header.found != NamedColumns::kNone) return header;
  for (const Separator other : kSeparators) {
    const TextHeader found = read_as(line, other, shape, choice);
    if (found.found != NamedColumns::kNone) return found;
  }
  return header;
}

std::string shown_names(std::string_view line, Separator separator) {
  constexpr std::size_t kMaxShown = 72;
  std::string shown;
  for (const std::string_view name : names_in(line, separator)) {
    const std::string next = (shown.empty() ? "'" : ", '") + octree::printable(name) + "'";
    if (shown.size() + next.size() > kMaxShown) return shown + ", ...";
    shown += next;
  }
  return shown;
}

bool lists_other_columns(std::string_view comment, Separator separator, std::size_t required,
                         std::size_t fields) {
  const auto names = names_in(comment, separator);
  const auto is_value = [](std::string_view name) {
    double value = 0;
    return parse_number(name, DecimalMark::kPoint, value);
  };
  if (names.size() != fields || std::any_of(names.begin(), names.end(), is_value)) return false;
  return fields > required || std::any_of(names.begin(), names.end(), is_axis);
}

}  // namespace planetree::tools
