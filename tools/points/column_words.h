#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The words in the names of columns.
namespace planetree::tools {

/// The axis that a name means, and what else it says: "pos" of "pos_x".
struct AxisName {
  std::size_t axis = 0;
  std::string family;
};

[[nodiscard]] std::string lower_case(std::string_view text);
[[nodiscard]] std::string upper_case(std::string_view text);

/// The name without what is in brackets, such as a unit.
[[nodiscard]] std::string without_brackets(std::string_view name);

/// The words of a name, in lower case and without a unit: "pos", "x" of "PosX [mm]".
[[nodiscard]] std::vector<std::string> words_of(std::string_view name);

/// The axis of a name with x, y or z, or 0, 1 or 2 behind a word for a position.
[[nodiscard]] std::optional<AxisName> axis_name(const std::vector<std::string>& words);

/// The axis of a name such as "easting", "north" or "height".
[[nodiscard]] std::optional<AxisName> survey_name(const std::vector<std::string>& words);

}  // namespace planetree::tools
