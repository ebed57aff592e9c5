#include "tools/points/column_names.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>

#include "tools/points/column_words.h"
#include "tools/points/line_fields.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kAxes = 3;

/// The columns of one kind of name.
struct Family {
  std::array<std::size_t, kAxes> counts{};
  AxisColumns columns{};

  void add(const AxisName& name, std::size_t column) {
    if (counts[name.axis]++ == 0) columns[name.axis] = column;
  }
  [[nodiscard]] bool is_complete() const {
    return std::count(counts.begin(), counts.end(), 0) == 0;
  }
  [[nodiscard]] bool is_single() const { return counts == decltype(counts){1, 1, 1}; }
};

NamedColumns take(const Family& family, AxisColumns& columns) {
  if (!family.is_single()) return NamedColumns::kAmbiguous;
  columns = family.columns;
  return NamedColumns::kOnce;
}

/// The number of a column as typed. Empty if the text is no number.
std::optional<std::size_t> number_of(std::string_view text) {
  std::size_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  if (code != std::errc() || stop != end) return std::nullopt;
  return value;
}

Error bad_choice(const RowShape& shape) {
  const std::string form = upper_case(shape.joined_names());
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "give the different columns of %s, as %s: names of the header, or numbers from "
                    "1",
                    shape.listed_names("and").c_str(), form.c_str());
}

/// Finds one name. `column` is unchanged if it is not found once.
NamedColumns find_name(std::string_view wanted, const std::vector<std::string_view>& names,
                       std::size_t& column) {
  std::size_t whole = 0, without_unit = 0, found = kNoColumn;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const bool is_whole = lower_case(names[i]) == lower_case(wanted);
    if (!is_whole && lower_case(without_brackets(names[i])) != lower_case(wanted)) continue;
    if (is_whole ? whole++ == 0 : whole == 0) found = i;
    without_unit += is_whole ? 0 : 1;
  }
  if (whole + without_unit == 0) return NamedColumns::kNone;
  if (whole > 1 || (whole == 0 && without_unit > 1)) return NamedColumns::kAmbiguous;
  column = found;
  return NamedColumns::kOnce;
}

}  // namespace

Result<ColumnChoice> ColumnChoice::parse(std::string_view text, const RowShape& shape) {
  constexpr std::size_t kMaxColumn = 100'000;
  ColumnChoice choice;
  for (LineFields fields(text, Separator::kComma); fields.next();) {
    const auto number = number_of(fields.field());
    if (fields.field().empty() || (number && (*number == 0 || *number > kMaxColumn)))
      return bad_choice(shape);
    choice.columns.emplace_back(fields.field());
  }
  auto sorted = choice.columns;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.size() < shape.required || sorted.size() > shape.count ||
      std::unique(sorted.begin(), sorted.end()) != sorted.end())
    return bad_choice(shape);
  return choice;
}

bool ColumnChoice::is_numeric() const {
  return !empty() && std::all_of(columns.begin(), columns.end(),
                                 [](const std::string& column) { return number_of(column); });
}

NamedColumns find_axes(const std::vector<std::string_view>& names, AxisColumns& columns) {
  std::map<std::string, Family> families;
  Family survey;
  for (std::size_t column = 0; column < names.size(); ++column) {
    const auto words = words_of(names[column]);
    if (const auto axis = axis_name(words)) families[axis->family].add(*axis, column);
    if (const auto axis = survey_name(words)) survey.add(*axis, column);
  }
  if (const auto plain = families.find(""); plain != families.end() && plain->second.is_complete())
    return take(plain->second, columns);
  NamedColumns found = NamedColumns::kNone;
  for (const auto& [name, family] : families) {
    if (!family.is_complete()) continue;
    if (found != NamedColumns::kNone) return NamedColumns::kAmbiguous;
    found = take(family, columns);
  }
  if (found != NamedColumns::kNone) return found;
  if (survey.is_complete()) return take(survey, columns);
  // x and y with a height
  Family mixed = families[""];
  mixed.counts[2] = survey.counts[2];
  mixed.columns[2] = survey.columns[2];
  return mixed.is_complete() ? take(mixed, columns) : NamedColumns::kNone;
}

NamedColumns find_named(const RowShape& shape, const std::vector<std::string_view>& names,
                        ColumnList& columns) {
  columns.assign(shape.count, kNoColumn);
  NamedColumns found = NamedColumns::kOnce;
  for (std::size_t i = 0; i < shape.count; ++i) {
    const NamedColumns named = find_name(shape.names[i], names, columns[i]);
    if (named == NamedColumns::kNone && i < shape.required) return NamedColumns::kNone;
    if (named == NamedColumns::kAmbiguous) found = NamedColumns::kAmbiguous;
  }
  while (columns.back() == kNoColumn && columns.size() > shape.required) columns.pop_back();
  return found;
}

NamedColumns find_chosen(const ColumnChoice& choice, const std::vector<std::string_view>& names,
                         ColumnList& columns) {
  columns.assign(choice.columns.size(), kNoColumn);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (const auto number = number_of(choice.columns[i])) {
      columns[i] = *number - 1;
      continue;
    }
    const NamedColumns found = find_name(choice.columns[i], names, columns[i]);
    if (found != NamedColumns::kOnce) return found;
  }
  ColumnList sorted = columns;
  std::sort(sorted.begin(), sorted.end());
  const bool distinct = std::unique(sorted.begin(), sorted.end()) == sorted.end();
  return distinct ? NamedColumns::kOnce : NamedColumns::kAmbiguous;
}

}  // namespace planetree::tools
