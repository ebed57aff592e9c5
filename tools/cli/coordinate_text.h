#pragma once

#include <span>
#include <string_view>

namespace planetree::tools {

/// Reads exactly values.size() finite numbers separated by commas. Returns false if the text is
/// anything else; `values` then holds unspecified numbers.
bool parse_coordinates(std::string_view text, std::span<double> values);

}  // namespace planetree::tools
