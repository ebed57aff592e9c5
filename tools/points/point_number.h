#pragma once

#include <cstdint>
#include <string_view>

namespace planetree::tools {

/// What separates the whole part of a number from its fraction.
enum class DecimalMark : std::uint8_t { kPoint, kComma };

/// Parses all of `text` as a number, correctly rounded. "nan", "inf" and their variants are
/// numbers, also as old Microsoft libraries print them ("-1.#IND"). With kComma a number has no
/// point. False if the text is none of these.
[[nodiscard]] bool parse_number(std::string_view text, DecimalMark mark, double& value);

/// Whether the text is digits, a comma and digits, with an optional sign and exponent.
[[nodiscard]] bool has_decimal_comma(std::string_view text);

}  // namespace planetree::tools
