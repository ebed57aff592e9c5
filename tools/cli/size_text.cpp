#include "tools/cli/size_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

namespace planetree::tools {
namespace {

/// Maximum digits of a fraction. Longer ones give no whole number with any suffix.
constexpr std::size_t kMaxFractionDigits = 18;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The power of `base` that a letter stands for, with 2^0 for none. Empty if it is no suffix.
std::optional<std::uint64_t> letter_factor(std::string_view letter, std::uint64_t base) {
  if (letter.empty()) return 1;
  if (letter.size() > 1) return std::nullopt;
  switch (letter[0] | 0x20) {
    case 'k':
      return base;
    case 'm':
      return base * base;
    case 'g':
      return base * base * base;
    case 't':
      return base * base * base * base;
    default:
      return std::nullopt;
  }
}

/// What a suffix of a number of bytes stands for: KiB is K, and KB a power of 1000.
std::optional<std::uint64_t> bytes_factor(std::string_view suffix) {
  if (suffix.empty() || (suffix.back() | 0x20) != 'b') return letter_factor(suffix, 1024);
  suffix.remove_suffix(1);
  if (suffix.size() != 2 || (suffix[1] | 0x20) != 'i') return letter_factor(suffix, 1000);
  return letter_factor(suffix.substr(0, 1), 1024);
}

std::optional<std::uint64_t> count_factor(std::string_view suffix) {
  return letter_factor(suffix, 1000);
}

/// The power of ten of an exponent such as "e6". Empty if it is none or too large.
std::optional<std::uint64_t> exponent_factor(std::string_view exponent) {
  if (exponent.size() > 1 && exponent[1] == '+') exponent.remove_prefix(1);
  exponent.remove_prefix(std::min<std::size_t>(exponent.size(), 1));
  if (exponent.empty() || exponent.size() > 2) return std::nullopt;
  unsigned power = 0;
  for (const char c : exponent) {
    if (!is_digit(c)) return std::nullopt;
    power = 10 * power + static_cast<unsigned>(c - '0');
  }
  std::uint64_t factor = 1;
  for (; power > 0; --power)
    if (__builtin_mul_overflow(factor, std::uint64_t{10}, &factor)) return std::nullopt;
  return factor;
}

std::string_view leading_digits(std::string_view text) {
  const auto end = std::find_if_not(text.begin(), text.end(), is_digit);
  return text.substr(0, static_cast<std::size_t>(end - text.begin()));
}

/// The digits as one integer. Empty on overflow.
std::optional<std::uint64_t> digits_value(std::string_view digits) {
  std::uint64_t value = 0;
  for (const char c : digits) {
    const std::uint64_t digit = static_cast<std::uint64_t>(c - '0');
    if (__builtin_mul_overflow(value, std::uint64_t{10}, &value)) return std::nullopt;
    if (__builtin_add_overflow(value, digit, &value)) return std::nullopt;
  }
  return value;
}

/// 0.digits times factor. Empty unless that is a whole number.
std::optional<std::uint64_t> fraction_value(std::string_view digits, std::uint64_t factor) {
  while (!digits.empty() && digits.back() == '0') digits.remove_suffix(1);
  if (digits.size() > kMaxFractionDigits) return std::nullopt;
  const std::uint64_t value = *digits_value(digits);
  std::uint64_t divisor = 1;
  for (std::size_t i = 0; i < digits.size(); ++i) divisor *= 10;
  // Reduces value * factor / divisor first, so that nothing overflows.
  const std::uint64_t common = std::gcd(divisor, factor);
  divisor /= common;
  if (value % divisor != 0) return std::nullopt;
  return value / divisor * (factor / common);
}

std::optional<std::uint64_t> parse(
    std::string_view text, std::optional<std::uint64_t> (*suffix_factor)(std::string_view)) {
  const std::string_view whole = leading_digits(text);
  if (whole.empty()) return std::nullopt;
  text.remove_prefix(whole.size());
  std::string_view fraction;
  if (text.starts_with('.')) {
    fraction = leading_digits(text.substr(1));
    if (fraction.empty()) return std::nullopt;
    text.remove_prefix(1 + fraction.size());
  }
  const bool has_exponent = text.starts_with('e') || text.starts_with('E');
  const auto factor = has_exponent ? exponent_factor(text) : suffix_factor(text);
  const auto units = digits_value(whole);
  if (!factor || !units) return std::nullopt;
  const auto rest = fraction_value(fraction, *factor);
  std::uint64_t value = 0;
  if (!rest || __builtin_mul_overflow(*units, *factor, &value)) return std::nullopt;
  if (__builtin_add_overflow(value, *rest, &value)) return std::nullopt;
  return value;
}

/// The text in quotes, truncated so that the remedy after it fits the error.
std::string quoted(std::string_view text) {
  constexpr std::size_t kMaxQuoted = 40;
  if (text.size() <= kMaxQuoted) return fmt::format("'{}'", text);
  return fmt::format("'{}...'", text.substr(0, kMaxQuoted));
}

std::string three_digits(double value, std::string_view unit) {
  const int decimals = value < 9.995 ? 2 : value < 99.95 ? 1 : 0;
  return fmt::format("{:.{}f} {}", value, decimals, unit);
}

}  // namespace

Result<std::uint64_t> parse_count(std::string_view text) {
  if (const auto value = parse(text, count_factor)) return *value;
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%s is not a count; give a whole number such as 5000, 20K, 1.5M or 1e6 (K is "
                    "1000)",
                    quoted(text).c_str());
}

Result<std::uint64_t> parse_bytes(std::string_view text) {
  if (const auto value = parse(text, bytes_factor)) return *value;
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%s is not a size; give a whole number of bytes such as 4096, 64K, 256M or "
                    "1.5G (K and KiB are 1024, KB is 1000)",
                    quoted(text).c_str());
}

std::string grouped_count(std::uint64_t count) {
  std::string digits = fmt::format("{}", count);
  for (std::size_t end = digits.size(); end > 3; end -= 3) digits.insert(end - 3, 1, ',');
  return digits;
}

std::string short_count(double count) {
  constexpr std::string_view kPrefixes[] = {"K", "M", "G", "T", "P", "E"};
  if (count < 999.5) return fmt::format("{:.{}f}", count, count < 9.95 ? 1 : 0);
  std::size_t prefix = 0;
  for (count /= 1000; count >= 999.5 && prefix + 1 < std::size(kPrefixes); ++prefix) count /= 1000;
  return three_digits(count, kPrefixes[prefix]);
}

std::string short_bytes(std::uint64_t bytes) {
  constexpr std::string_view kUnits[] = {"KiB", "MiB", "GiB", "TiB", "PiB", "EiB"};
  if (bytes < 1024) return fmt::format("{} B", bytes);
  std::size_t unit = 0;
  double value = static_cast<double>(bytes) / 1024;
  for (; value >= 1023.5 && unit + 1 < std::size(kUnits); ++unit) value /= 1024;
  return three_digits(value, kUnits[unit]);
}

}  // namespace planetree::tools
