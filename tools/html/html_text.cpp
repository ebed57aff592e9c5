#include "tools/html/html_text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace planetree::tools {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";  // U+FFFD

unsigned byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

/// Bytes of the UTF-8 character that the text begins with; 0 if it begins with none. The Unicode
/// Standard, table 3-7.
std::size_t character_bytes(std::string_view text) {
  const unsigned lead = byte_at(text, 0);
  if (lead < 0x80) return 1;
  const std::size_t bytes = lead >= 0xC2 && lead <= 0xDF   ? 2
                            : lead >= 0xE0 && lead <= 0xEF ? 3
                            : lead >= 0xF0 && lead <= 0xF4 ? 4
                                                           : 0;
  if (bytes == 0 || text.size() < bytes) return 0;
  const unsigned least = lead == 0xE0 ? 0xA0 : lead == 0xF0 ? 0x90 : 0x80;
  const unsigned greatest = lead == 0xED ? 0x9F : lead == 0xF4 ? 0x8F : 0xBF;
  if (byte_at(text, 1) < least || byte_at(text, 1) > greatest) return 0;
  for (std::size_t i = 2; i < bytes; ++i)
    if (byte_at(text, i) < 0x80 || byte_at(text, i) > 0xBF) return 0;
  return bytes;
}

std::string_view escaped(std::string_view character) {
  switch (character[0]) {
    case '&':
      return "&amp;";
    case '<':
      return "&lt;";
    case '>':
      return "&gt;";
    case '"':
      return "&quot;";
    case '\'':
      return "&#39;";
    default:
      return byte_at(character, 0) < 0x20 || character[0] == 0x7F ? kReplacement : character;
  }
}

/// "1.50" as "1.5", "2.0" as "2".
std::string without_end_zeros(std::string digits) {
  while (digits.find('.') != std::string::npos && (digits.back() == '0' || digits.back() == '.'))
    digits.pop_back();
  return digits;
}

/// "1.20e-05" as "1.2e-5", where the zeros at the end of the digits stay if `keep_zeros`.
std::string short_exponent(std::string text, bool keep_zeros) {
  const std::size_t e = text.find('e');
  const std::string digits = keep_zeros ? text.substr(0, e) : without_end_zeros(text.substr(0, e));
  std::size_t power = e + 2;
  while (text[power] == '0' && power + 1 < text.size()) ++power;
  return digits + (text[e + 1] == '-' ? "e-" : "e") + text.substr(power);
}

}  // namespace

std::string html_text(std::string_view text) {
  std::string html;
  while (!text.empty()) {
    const std::size_t bytes = character_bytes(text);
    html += bytes == 0 ? kReplacement : escaped(text.substr(0, bytes));
    text.remove_prefix(bytes == 0 ? 1 : bytes);
  }
  return html;
}

std::string script_json(const nlohmann::ordered_json& value) {
  std::string script;
  for (const char c : value.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace))
    switch (c) {
      case '<':
        script += "\\u003c";
        break;
      case '>':
        script += "\\u003e";
        break;
      case '&':
        script += "\\u0026";
        break;
      default:
        script += c;
    }
  return script;
}

std::string number_text(double value) {
  const double size = std::fabs(value);
  if (size == 0) return "0";
  if (size < 0.000995 || size >= 99995) return short_exponent(fmt::format("{:.2e}", value), false);
  const int decimals = size < 0.00995  ? 5
                       : size < 0.0995 ? 4
                       : size < 0.995  ? 3
                       : size < 9.95   ? 2
                       : size < 99.5   ? 1
                                       : 0;
  return fmt::format("{:.{}f}", value, decimals);
}

std::string power_text(double value) {
  return value == 0 ? "0" : short_exponent(fmt::format("{:.1e}", value), true);
}

std::string short_text(double value) {
  const double size = std::fabs(value);
  if (size == 0) return "0";
  if (size < 0.00995 || size >= 9950) return short_exponent(fmt::format("{:.1e}", value), false);
  const int decimals = size < 0.0995 ? 3 : size < 0.995 ? 2 : size < 9.95 ? 1 : 0;
  return without_end_zeros(fmt::format("{:.{}f}", value, decimals));
}

std::string short_power_text(double value) {
  if (value == 0 || std::fabs(value) >= 0.995) return short_text(value);
  return short_exponent(fmt::format("{:.1e}", value), false);
}

}  // namespace planetree::tools
