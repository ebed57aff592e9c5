#include "tools/points/point_number.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::tools {
namespace {

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }
constexpr bool is_alphanumeric(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// Whether what follows the '#' of a number is one of the names that old libraries print there, and
/// not a comment.
bool is_old_name(std::string_view text, std::size_t hash) {
  return hash > 0 && text[hash - 1] == '.' && hash + 1 < text.size() &&
         std::all_of(text.begin() + static_cast<std::ptrdiff_t>(hash) + 1, text.end(),
                     is_alphanumeric);
}

}  // namespace

bool parse_number(std::string_view text, DecimalMark mark, double& value) {
  std::array<char, 64> copy{};
  if (mark == DecimalMark::kComma) {
    if (text.size() > copy.size() || text.find('.') != std::string_view::npos) return false;
    std::replace_copy(text.begin(), text.end(), copy.begin(), ',', '.');
    text = {copy.data(), text.size()};
  }
  if (!octree::parse_real(text, value)) return false;
  if (!std::isnan(value)) return true;
  const std::size_t hash = text.find('#');
  return hash == std::string_view::npos || is_old_name(text, hash);
}

bool has_decimal_comma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == 0 || comma == std::string_view::npos || comma + 1 == text.size()) return false;
  double value = 0;
  return is_digit(text[comma - 1]) && is_digit(text[comma + 1]) &&
         parse_number(text, DecimalMark::kComma, value);
}

}  // namespace planetree::tools
