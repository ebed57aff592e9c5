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

/// The power of `base` that a suffix stands for. Empty if it is not a suffix.
std::optional<std::uint64_t> suffix_factor(std::string_view suffix, std::uint64_t base) {
  if (suffix.empty()) return 1;
  if (suffix.size() > 1) return std::nullopt;
  switch (suffix[0] | 0x20) {
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

std::optional<std::uint64_t> parse(std::string_view text, std::uint64_t base) {
  const std::string_view whole = leading_digits(text);
  if (whole.empty()) return std::nullopt;
  text.remove_prefix(whole.size());
  std::string_view fraction;
  if (text.starts_with('.')) {
    fraction = leading_digits(text.substr(1));
    if (fraction.empty()) return std::nullopt;
    text.remove_prefix(1 + fraction.size());
  }
  const auto factor = suffix_factor(text, base);
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
  if (const auto value = parse(text, 1000)) return *value;
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%s is not a count; give a whole number such as 5000, 20K, 1.5M or 2G (K is "
                    "1000)",
                    quoted(text).c_str());
}

Result<std::uint64_t> parse_bytes(std::string_view text) {
  if (const auto value = parse(text, 1024)) return *value;
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "%s is not a size; give a whole number of bytes such as 4096, 64K, 256M or "
                    "1.5G (K is 1024)",
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
