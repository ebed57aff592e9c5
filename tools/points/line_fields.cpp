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

bool LineFields::is_separator(char c) const {
  return c == character_of(separator_) || (c == '\t' && separator_ == Separator::kBlank);
}

std::size_t LineFields::find_separator(std::size_t from) const {
  while (from < rest_.size() && !is_separator(rest_[from])) ++from;
  return from;
}

bool LineFields::next() {
  if (ended_) return false;
  std::size_t begin = 0;
  while (begin < rest_.size() && is_blank(rest_[begin]) &&
         (separator_ == Separator::kBlank || !is_separator(rest_[begin])))
    ++begin;
  if (begin == rest_.size() && separator_ == Separator::kBlank) return false;
  std::size_t end = begin;
  if (begin < rest_.size() && rest_[begin] == '"') end = closing_quote(rest_, begin + 1);
  end = end == std::string_view::npos ? rest_.size() : find_separator(end);
  field_ = trimmed(rest_.substr(begin, end - begin));
  if (field_.size() >= 2 && field_.front() == '"' && field_.back() == '"')
    field_ = trimmed(field_.substr(1, field_.size() - 2));
  ended_ = end == rest_.size();
  rest_.remove_prefix(ended_ ? end : end + 1);
  return true;
}

}  // namespace planetree::tools
