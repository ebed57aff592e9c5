#include "tools/points/line_fields.h"

namespace planetree::tools {
namespace {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t'; }

constexpr char character_of(Separator separator) {
  switch (separator) {
    case Separator::kSemicolon:
      return ';';
    case Separator::kTab:
      return '\t';
    case Separator::kComma:
      return ',';
    case Separator::kBlank:
      break;
  }
  return ' ';
}

/// The first quote behind `from` that is not one of a pair.
std::size_t closing_quote(std::string_view text, std::size_t from) {
  std::size_t quote = text.find('"', from);
  while (quote != std::string_view::npos && text.substr(quote + 1, 1) == "\"")
    quote = text.find('"', quote + 2);
  return quote;
}

}  // namespace

const char* separator_word(Separator separator) {
  switch (separator) {
    case Separator::kSemicolon:
      return "semicolon";
    case Separator::kTab:
      return "tab";
    case Separator::kComma:
      return "comma";
    case Separator::kBlank:
      break;
  }
  return "blank";
}

std::string_view trimmed(std::string_view text) {
  std::size_t begin = 0, end = text.size();
  while (begin < end && is_blank(text[begin])) ++begin;
  while (end > begin && is_blank(text[end - 1])) --end;
  return text.substr(begin, end - begin);
}

LineFields::LineFields(std::string_view line, Separator separator)
    : rest_(line),
      separator_(character_of(separator)),
      other_separator_(separator == Separator::kBlank ? '\t' : separator_) {}

const char* LineFields::find_separator(const char* from) const {
  const char* const end = rest_.data() + rest_.size();
  while (from < end && *from != separator_ && *from != other_separator_) ++from;
  return from;
}

bool LineFields::next() {
  if (ended_) return false;
  const char* begin = rest_.data();
  const char* const end = begin + rest_.size();
  const bool is_tab = separator_ == '\t';
  while (begin < end && (*begin == ' ' || (*begin == '\t' && !is_tab))) ++begin;
  if (begin == end && separator_ == ' ') return false;
  const char* closing = begin;
  if (begin < end && *begin == '"') {
    const std::size_t quote =
        closing_quote(rest_, static_cast<std::size_t>(begin - rest_.data()) + 1);
    closing = quote == std::string_view::npos ? end : rest_.data() + quote;
  }
  const char* const field_end = find_separator(closing);
  field_ = trimmed({begin, static_cast<std::size_t>(field_end - begin)});
  if (field_.size() >= 2 && field_.front() == '"' && field_.back() == '"')
    field_ = trimmed(field_.substr(1, field_.size() - 2));
  ended_ = field_end == end;
  rest_.remove_prefix(static_cast<std::size_t>(field_end - rest_.data()) + (ended_ ? 0 : 1));
  return true;
}

}  // namespace planetree::tools
