#include "storage/http/reply_head.h"

#include <algorithm>
#include <charconv>

#include "storage/http/letter_case.h"

namespace planetree::storage {
namespace {

constexpr std::string_view kBlanks = " \t\r\n";

std::string_view trimmed(std::string_view text) noexcept {
  const std::size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

// Reads a number at the start of a text and removes it. Nothing else but digits counts.
template <class Number>
bool take_number(std::string_view& text, Number& number) noexcept {
  if (text.empty() || text.front() < '0' || text.front() > '9') return false;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), number);
  if (read.ec != std::errc()) return false;
  text.remove_prefix(static_cast<std::size_t>(read.ptr - text.data()));
  return true;
}

bool take(std::string_view& text, char expected) noexcept {
  if (!text.starts_with(expected)) return false;
  text.remove_prefix(1);
  return true;
}

// An entity tag is sent back to the server, so that it must not be able to end the line.
bool is_etag(std::string_view value) noexcept {
  if (value.starts_with("W/")) value.remove_prefix(2);
  if (value.size() < 2 || value.front() != kQuote || value.back() != kQuote) return false;
  value = value.substr(1, value.size() - 2);
  return std::ranges::all_of(value, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte > 0x20 && byte != kQuote && byte != 0x7f;
  });
}

bool is_printable(std::string_view value) noexcept {
  return std::ranges::all_of(value, [](char c) { return c >= 0x20 && c < 0x7f; });
}

// The code of a status line such as `HTTP/1.1 206 Partial Content`.
int status_in(std::string_view line) noexcept {
  std::string_view rest = trimmed(line.substr(std::min(line.find(' '), line.size())));
  int status = 0;
  return take_number(rest, status) && status >= 100 && status <= 999 ? status : 0;
}

}  // namespace

std::optional<ContentRange> ContentRange::parse(std::string_view value) noexcept {
  constexpr std::string_view kUnit = "bytes";
  value = trimmed(value);
  if (value.size() < kUnit.size() || !equals_in_any_case(value.substr(0, kUnit.size()), kUnit))
    return {};
  value = value.substr(kUnit.size());
  if (!take(value, ' ')) return {};
  value = trimmed(value);
  ContentRange range;
  if (!take_number(value, range.first) || !take(value, '-') || !take_number(value, range.last) ||
      !take(value, '/') || !take_number(value, range.total) || !value.empty())
    return {};
  if (range.first > range.last || range.last >= range.total) return {};
  return range;
}

void ReplyHead::add_line(std::string_view line) {
  line = trimmed(line);
  if (line.starts_with("HTTP/")) {
    *this = {};
    status_ = status_in(line);
    return;
  }
  const std::size_t colon = line.find(':');
  if (colon == std::string_view::npos) return;
  const std::string_view name = line.substr(0, colon);
  std::string_view value = trimmed(line.substr(colon + 1));
  if (value.size() > kMaxFieldBytes) return;
  if (equals_in_any_case(name, "etag") && is_etag(value)) etag_ = value;
  if (equals_in_any_case(name, "last-modified") && is_printable(value)) last_modified_ = value;
  if (equals_in_any_case(name, "content-range")) range_ = ContentRange::parse(value);
  if (equals_in_any_case(name, "content-encoding"))
    is_encoded_ = !value.empty() && value != "identity";
  if (equals_in_any_case(name, "retry-after") && !take_number(value, retry_after_seconds_))
    retry_after_seconds_ = 0;
}

}  // namespace planetree::storage
