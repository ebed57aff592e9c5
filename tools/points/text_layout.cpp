#include "tools/points/text_layout.h"

#include <algorithm>
#include <charconv>
#include <cinttypes>
#include <numeric>
#include <span>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/points/column_words.h"
#include "tools/points/decimal_mark.h"
#include "tools/points/sample_lines.h"
#include "tools/points/text_header.h"

namespace planetree::tools {
namespace {

using Line = SampleLines::Line;

/// Whether a line is "sep=;" or the like, which spreadsheets write first.
bool is_separator_hint(std::string_view line) {
  return line.size() == 5 && octree::is_same_word(line.substr(0, 4), "sep=");
}

std::string_view first_word(std::string_view line) { return octree::take_word(line); }

class LayoutFinder {
 public:
  LayoutFinder(std::string_view front, const RowShape& shape, const ColumnChoice& choice)
      : sample_(front), lines_(sample_.lines()), shape_(shape), choice_(choice) {
    layout_.separator = sample_.separator(shape.required);
  }

  Result<TextLayout> find() {
    find_first_row();
    if (const auto found = find_columns(); !found) return found.error();
    if (row_ == lines_.size()) return layout_;
    layout_.first_row = lines_[row_].number;
    layout_.min_fields = find_min_fields();
    const auto decimal =
        find_decimal_mark(std::span(lines_).subspan(row_), layout_.separator, layout_.columns);
    if (!decimal) return decimal.error();
    layout_.decimal = *decimal;
    return layout_;
  }

 private:
  /// Passes comments, a count, titles and the header.
  void find_first_row() {
    while (row_ < lines_.size() && (take_comment() || take_count() || take_words())) ++row_;
  }

  bool take_comment() {
    const Line& line = lines_[row_];
    if (!is_comment(line.text)) return false;
    comment_ = &line;
    take_header(line);
    return true;
  }

  bool take_header(const Line& line) {
    if (choice_.is_numeric()) return false;
    const TextHeader header = read_header(line.text, layout_.separator, shape_, choice_);
    if (header.found == NamedColumns::kNone) return false;
    header_ = header;
    header_line_ = &line;
    return true;
  }

  /// A count is a whole number alone in front of a row.
  bool take_count() {
    const Line& line = lines_[row_];
    if (layout_.declared_count || words_ != nullptr || !is_count(line.text)) return false;
    std::size_t next = row_ + 1;
    while (next < lines_.size() && is_comment(lines_[next].text)) ++next;
    if (next == lines_.size() ||
        count_fields(lines_[next].text, layout_.separator).fields < shape_.required)
      return false;
    std::uint64_t count = 0;
    const std::string_view digits = trimmed(line.text);
    std::from_chars(digits.data(), digits.data() + digits.size(), count);
    layout_.declared_count = count;
    layout_.count_line = line.number;
    return true;
  }

  /// A header, or a line without a number in front of it.
  bool take_words() {
    const Line& line = lines_[row_];
    if (row_ == 0 && is_separator_hint(line.text)) return true;
    if (header_line_ != nullptr && !is_comment(header_line_->text)) return false;
    if (!take_header(line) &&
        (header_line_ != nullptr || count_fields(line.text, layout_.separator).numbers > 0))
      return false;
    words_ = &line;
    return true;
  }

  Result<void> find_columns() {
    if (choice_.is_numeric()) {
      layout_.columns = find_chosen_columns();
      return {};
    }
    if (header_line_ != nullptr) return take_header_columns();
    const Line* const names = words_ != nullptr ? words_ : comment_;
    if (!choice_.empty()) return names != nullptr ? without_names(*names) : without_header();
    if (words_ != nullptr) return without_names(*words_);
    if (row_ == lines_.size()) return {};
    const std::string_view text = lines_[row_].text;
    const FieldCounts counts = count_fields(text, layout_.separator);
    if (comment_ != nullptr &&
        lists_other_columns(comment_->text, layout_.separator, shape_.required, counts.fields))
      return without_names(*comment_);
    layout_.is_obj = shape_.kind == RowKind::kPoint && layout_.separator == Separator::kBlank &&
                     counts.numbers >= 3 && first_word(text) == "v";
    return take_first_columns();
  }

  /// Takes the first columns of the first row, or those behind the v of an OBJ. A row may have all
  /// optional numbers or none.
  Result<void> take_first_columns() {
    LineFields fields(lines_[row_].text, layout_.separator);
    std::size_t numbers = 0;
    while (fields.next() && is_number(fields.field())) ++numbers;
    const bool has_optional = numbers == shape_.count;
    if (numbers > shape_.required && shape_.count > shape_.required && !has_optional)
      return ambiguous_row(numbers);
    const std::size_t first = layout_.is_obj ? 1 : 0;
    layout_.columns.resize(has_optional ? shape_.count : shape_.required);
    std::iota(layout_.columns.begin(), layout_.columns.end(), first);
    return {};
  }

  [[nodiscard]] ColumnList find_chosen_columns() const {
    ColumnList columns;
    static_cast<void>(find_chosen(choice_, {}, columns));
    return columns;
  }

  Result<void> take_header_columns() {
    if (header_.found == NamedColumns::kAmbiguous)
      return refusal(header_line_->number,
                     choice_.empty() ? "it names " + shape_.listed_names("or") + " more than once"
                                     : "it has a name of --columns more than once");
    layout_.columns = header_.columns;
    if (row_ == lines_.size()) return {};
    const std::string_view row = lines_[row_].text;
    const std::size_t fields = count_fields(row, layout_.separator).fields;
    if (!is_shifted(row, fields)) return {};
    if (is_comment(header_line_->text) && fields == shape_.required && choice_.empty())  // prose
      return take_first_columns();
    return refusal(lines_[row_].number, "the row has " + std::to_string(fields) +
                                            " columns and the header " +
                                            std::to_string(header_.fields));
  }

  /// Whether the names may not be those of the columns below them: names with blanks, rows that
  /// begin with a name of their own, or prose.
  [[nodiscard]] bool is_shifted(std::string_view row, std::size_t fields) const {
    const bool is_quoted = trimmed(row).starts_with('"') && std::ranges::count(row, '"') == 2;
    const bool is_blank = layout_.separator == Separator::kBlank;
    const bool is_strict = is_blank || header_.separator != layout_.separator;
    const bool is_table = is_blank || layout_.separator == Separator::kTab || is_quoted;
    if (!is_comment(header_line_->text) && is_table && header_.fields + 1 == fields) return true;
    bool in_front = true;
    for (const std::size_t column : layout_.columns)
      in_front = in_front && (column < layout_.columns.size() || column == kNoColumn);
    return is_strict && header_.fields != fields && !in_front;
  }

  /// A value that is missing between blanks would shift the others. Rows of names that have blanks
  /// of their own differ in length.
  [[nodiscard]] std::size_t find_min_fields() const {
    if (layout_.separator != Separator::kBlank) return 0;
    const FieldCounts counts = count_fields(lines_[row_].text, layout_.separator);
    const bool is_named = header_line_ != nullptr && header_.fields == counts.fields;
    return is_named || counts.fields == counts.numbers ? counts.fields : 0;
  }

  /// Short where the names are many, because messages have a limited length.
  [[nodiscard]] std::string columns_remedy() const {
    if (shape_.kind != RowKind::kPoint) return "name them by a header or --columns";
    return "give --columns " + upper_case(shape_.joined_names()) + " by name or number";
  }
  [[nodiscard]] Error refusal(std::uint64_t line, const std::string& cause) const {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "line %" PRIu64 ": %s; %s", line, cause.c_str(), columns_remedy().c_str());
  }
  [[nodiscard]] Error ambiguous_row(std::size_t numbers) const {
    return refusal(lines_[row_].number, "the row has " + std::to_string(numbers) +
                                            " numbers, and a " + shape_.noun + " has " +
                                            std::to_string(shape_.required) + " or " +
                                            std::to_string(shape_.count));
  }
  [[nodiscard]] Error without_names(const Line& names) const {
    const std::string shown = shown_names(names.text, layout_.separator);
    const std::string wanted =
        choice_.empty() ? shape_.listed_names("and") + " are not" : "--columns are not all";
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "line %" PRIu64 ": %s among its names %s (separator: %s); %s", names.number,
                      wanted.c_str(), shown.c_str(), separator_word(layout_.separator),
                      columns_remedy().c_str());
  }
  [[nodiscard]] static Error without_header() {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "it has no header with the names of --columns; give their numbers, from 1");
  }

  SampleLines sample_;
  const std::vector<Line>& lines_;
  const RowShape& shape_;
  const ColumnChoice& choice_;
  TextLayout layout_;
  std::size_t row_ = 0;            // of the first row in lines_
  const Line* comment_ = nullptr;  // the last comment in front of it
  const Line* words_ = nullptr;    // the last line without numbers in front of it
  const Line* header_line_ = nullptr;
  TextHeader header_;
};

}  // namespace

Result<TextLayout> find_text_layout(std::string_view front, const RowShape& shape,
                                    const ColumnChoice& choice) {
  return LayoutFinder(front, shape, choice).find();
}

}  // namespace planetree::tools
