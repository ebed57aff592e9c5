#pragma once

#include <string_view>
#include <vector>

#include "tools/picture/drawing.h"

/// Letters made of lines, so that text has the same pixels on every machine. The glyphs are
/// planetree's own. They cover printable ASCII; other characters become a box each.
namespace planetree::tools {

/// The length of a text whose capital letters have this height.
[[nodiscard]] double text_length(std::string_view text, double height);

/// The text as strokes in its place.
[[nodiscard]] Stroke text_stroke(const TextLine& line);

/// The text, shortened in its middle by "..." to a length.
[[nodiscard]] std::string shortened(std::string_view text, double height, double length);

}  // namespace planetree::tools
