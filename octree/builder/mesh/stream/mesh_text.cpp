#include "octree/builder/mesh/stream/mesh_text.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <system_error>

namespace planetree::octree {

namespace {

constexpr bool is_digit(char c) noexcept { return c >= '0' && c <= '9'; }

/// Whether a decimal number outside of T's range is too large, not too small: whether its first
/// digit other than 0 is in front of the point, after the exponent has shifted the point.
bool is_large(std::string_view number) noexcept {
  const std::size_t exponent_at = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, exponent_at);
  const std::size_t point = std::min(digits.find('.'), digits.size());
  const std::size_t leading = digits.find_first_of("123456789");
  if (leading == std::string_view::npos) return false;
  std::int64_t exponent = 0;
  if (exponent_at < number.size()) {
    std::string_view rest = number.substr(exponent_at + 1);
    take_integer(rest, exponent);
  }
  const auto digits_before_point =
      static_cast<std::int64_t>(point) - static_cast<std::int64_t>(leading);
  // Compared without adding, so that a saturated exponent does not overflow.
  return exponent > -digits_before_point;
}

template <class T>
bool parse(std::string_view word, T& value) noexcept {
  if (word.size() > 1 && word.front() == '+' && word[1] != '-') word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  const auto [stop, code] = std::from_chars(word.data(), end, value);
  if (code == std::errc::invalid_argument) return false;
  if (code == std::errc::result_out_of_range) {
    const bool large = is_large(word.substr(0, static_cast<std::size_t>(stop - word.data())));
    value = large ? std::numeric_limits<T>::infinity() : T{0};
  }
  if (stop == end) return true;
  value = std::numeric_limits<T>::quiet_NaN();
  return *stop == '#';
}

std::string_view without_comment(std::string_view line) noexcept {
  std::size_t hash = line.find('#');
  while (hash != std::string_view::npos && hash > 0 && line[hash - 1] == '.')
    hash = line.find('#', hash + 1);
  return line.substr(0, hash);
}

}  // namespace

TextPosition text_begin(std::string_view file) noexcept {
  return {file.substr(0, 3) == "\xEF\xBB\xBF" ? std::uint64_t{3} : std::uint64_t{0}, 1};
}

bool LineScanner::ends_line(char c) const noexcept {
  return (c == '\n' && line_end_ != LineEnd::kCarriageReturn) ||
         (c == '\r' && line_end_ != LineEnd::kNewline);
}

bool LineScanner::next() noexcept {
  if (after_.offset >= text_.size()) return false;
  position_ = after_;
  const auto begin = static_cast<std::size_t>(position_.offset);
  std::size_t end = begin;
  while (end < text_.size() && !ends_line(text_[end])) ++end;
  line_ = text_.substr(begin, end - begin);
  const bool is_pair = line_end_ == LineEnd::kAny && text_.substr(end, 2) == "\r\n";
  after_.offset = std::min(end + (is_pair ? 2 : 1), text_.size());
  after_.line = position_.line + 1;
  if (comment_ == LineComment::kHash) line_ = without_comment(line_);
  return true;
}

bool LineScanner::next_filled() noexcept {
  while (next()) {
    if (!std::all_of(line_.begin(), line_.end(), is_space)) return true;
  }
  return false;
}

std::string_view take_word(std::string_view& rest) noexcept {
  std::size_t begin = 0;
  while (begin < rest.size() && is_space(rest[begin])) ++begin;
  std::size_t end = begin;
  while (end < rest.size() && !is_space(rest[end])) ++end;
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

bool is_same_word(std::string_view word, std::string_view lower) noexcept {
  const auto same = [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  };
  return std::equal(word.begin(), word.end(), lower.begin(), lower.end(), same);
}

bool parse_real(std::string_view word, float& value) noexcept { return parse(word, value); }
bool parse_real(std::string_view word, double& value) noexcept { return parse(word, value); }

bool parse_real(std::string_view word, float& value, double& nearest) noexcept {
  if (!parse(word, nearest)) return false;
  // Rounding twice differs from rounding once only where the double lies halfway between floats.
  constexpr std::uint64_t kLowBits = (std::uint64_t{1} << 29) - 1, kHalf = std::uint64_t{1} << 28;
  const double magnitude = std::fabs(nearest);
  const bool is_plain = magnitude >= static_cast<double>(std::numeric_limits<float>::min()) &&
                        magnitude <= static_cast<double>(std::numeric_limits<float>::max()) &&
                        (std::bit_cast<std::uint64_t>(nearest) & kLowBits) != kHalf;
  if (!is_plain) return parse(word, value);
  value = static_cast<float>(nearest);
  return true;
}

bool exceeds_float(std::string_view word, float value, double nearest) noexcept {
  constexpr std::size_t kFloatDigits = 9;
  if (!std::isfinite(value) || static_cast<double>(value) == nearest) return false;
  // Digits, counted from the first that is not 0, and the exponent of the last that is not 0.
  std::size_t digits = 0, zeros = 0;
  std::int64_t exponent = 0;
  bool is_behind_point = false;
  std::size_t at = 0;
  for (; at < word.size() && (word[at] != 'e' && word[at] != 'E'); ++at) {
    const char c = word[at];
    if (c == '.') is_behind_point = true;
    if (!is_digit(c)) continue;
    exponent -= is_behind_point ? 1 : 0;
    if (c == '0') {
      zeros += digits > 0 ? 1 : 0;
      continue;
    }
    digits += zeros + 1;
    zeros = 0;
  }
  if (digits <= kFloatDigits) return false;
  exponent += static_cast<std::int64_t>(zeros);
  if (at < word.size()) {
    std::string_view rest = word.substr(at + 1);
    std::int64_t written = 0;
    if (take_integer(rest, written)) exponent += std::clamp<std::int64_t>(written, -400, 400);
  }
  // Printed from the float, the digits differ from it by half of the last one.
  const double half = 0.5000001 * std::pow(10.0, static_cast<double>(exponent));
  const double rounding = 0x1p-52 * std::fabs(nearest);
  return std::fabs(nearest - static_cast<double>(value)) > half + rounding;
}

bool take_integer(std::string_view& word, std::int64_t& value) noexcept {
  std::string_view digits = word;
  if (digits.size() > 1 && digits.front() == '+' && is_digit(digits[1])) digits.remove_prefix(1);
  const auto [stop, code] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (code == std::errc::invalid_argument) return false;
  if (code == std::errc::result_out_of_range) {
    value = digits.front() == '-' ? std::numeric_limits<std::int64_t>::min()
                                  : std::numeric_limits<std::int64_t>::max();
  }
  word.remove_prefix(static_cast<std::size_t>(stop - word.data()));
  return true;
}

std::string printable(std::string_view word) {
  constexpr std::size_t kMaxCharacters = 24;
  std::string shown(word.substr(0, kMaxCharacters));
  for (char& c : shown) {
    if (c < ' ' || c > '~') c = '?';
  }
  if (word.size() > kMaxCharacters) shown += "...";
  return shown;
}

}  // namespace planetree::octree
