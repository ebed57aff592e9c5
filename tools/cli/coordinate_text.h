#pragma once

#include <span>
#include <string_view>

namespace planetree::tools {

/// Reads as many finite numbers as there is room for, with commas between them and nothing
/// else. False, and anything written, if the text is other than that.
bool parse_coordinates(std::string_view text, std::span<double> values);

}  // namespace planetree::tools
