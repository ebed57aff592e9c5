#include "tools/cli/coordinate_text.h"

#include <charconv>
#include <cmath>
#include <cstddef>
#include <system_error>

namespace planetree::tools {

bool parse_coordinates(std::string_view text, std::span<double> values) {
  const char* at = text.data();
  const char* const end = at + text.size();
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ',')) return false;
    const auto [after, fault] = std::from_chars(at, end, values[i]);
    if (fault != std::errc{} || !std::isfinite(values[i])) return false;
    at = after;
  }
  return at == end;
}

}  // namespace planetree::tools
