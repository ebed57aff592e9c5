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

NamedAxes take(const Family& family, AxisColumns& columns) {
  if (!family.is_single()) return NamedAxes::kAmbiguous;
  columns = family.columns;
  return NamedAxes::kOnce;
}

/// The number of a column as typed. Empty if the text is no number.
std::optional<std::size_t> number_of(std::string_view text) {
  std::size_t value = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, value);
  if (code != std::errc() || stop != end) return std::nullopt;
  return value;
}

Error bad_choice() {
  return make_error(
      ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
      "give the three different columns of x, y and z, as X,Y,Z: names of the header, "
      "or numbers from 1");
}

}  // namespace

Result<ColumnChoice> ColumnChoice::parse(std::string_view text) {
  constexpr std::size_t kMaxColumn = 100'000;
  ColumnChoice choice;
  for (LineFields fields(text, Separator::kComma); fields.next();) {
    const auto number = number_of(fields.field());
    if (fields.field().empty() || (number && (*number == 0 || *number > kMaxColumn)))
      return bad_choice();
    choice.columns.emplace_back(fields.field());
  }
  auto sorted = choice.columns;
  std::sort(sorted.begin(), sorted.end());
  if (sorted.size() != kAxes || std::unique(sorted.begin(), sorted.end()) != sorted.end())
    return bad_choice();
  return choice;
}

bool ColumnChoice::is_numeric() const {
  return !empty() && std::all_of(columns.begin(), columns.end(),
                                 [](const std::string& column) { return number_of(column); });
}

NamedAxes find_axes(const std::vector<std::string_view>& names, AxisColumns& columns) {
  std::map<std::string, Family> families;
  Family survey;
  for (std::size_t column = 0; column < names.size(); ++column) {
    const auto words = words_of(names[column]);
    if (const auto axis = axis_name(words)) families[axis->family].add(*axis, column);
    if (const auto axis = survey_name(words)) survey.add(*axis, column);
  }
  if (const auto plain = families.find(""); plain != families.end() && plain->second.is_complete())
    return take(plain->second, columns);
  NamedAxes found = NamedAxes::kNone;
  for (const auto& [name, family] : families) {
    if (!family.is_complete()) continue;
    if (found != NamedAxes::kNone) return NamedAxes::kAmbiguous;
    found = take(family, columns);
  }
  if (found != NamedAxes::kNone) return found;
  if (survey.is_complete()) return take(survey, columns);
  // x and y with a height
  Family mixed = families[""];
  mixed.counts[2] = survey.counts[2];
  mixed.columns[2] = survey.columns[2];
  return mixed.is_complete() ? take(mixed, columns) : NamedAxes::kNone;
}

NamedAxes find_chosen(const ColumnChoice& choice, const std::vector<std::string_view>& names,
                      AxisColumns& columns) {
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    const std::string& wanted = choice.columns[axis];
    if (const auto number = number_of(wanted)) {
      columns[axis] = *number - 1;
      continue;
    }
    std::size_t whole = 0, without_unit = 0;
    for (std::size_t column = 0; column < names.size(); ++column) {
      const bool is_whole = lower_case(names[column]) == lower_case(wanted);
      if (!is_whole && lower_case(without_brackets(names[column])) != lower_case(wanted)) continue;
      if (is_whole ? whole++ == 0 : whole == 0) columns[axis] = column;
      without_unit += is_whole ? 0 : 1;
    }
    if (whole + without_unit == 0) return NamedAxes::kNone;
    if (whole > 1 || (whole == 0 && without_unit > 1)) return NamedAxes::kAmbiguous;
  }
  const bool distinct =
      columns[0] != columns[1] && columns[1] != columns[2] && columns[2] != columns[0];
  return distinct ? NamedAxes::kOnce : NamedAxes::kAmbiguous;
}

}  // namespace planetree::tools
