#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planetree/layers.h"

namespace planetree::tools {

/// Returns the layers in a list of their words, such as "distance,side", with the distance layer. 0
/// if it is no such list.
std::uint32_t layers_of(const std::string& text);

/// Returns the words of layers, in the order distance, side, field, attributes.
std::vector<std::string> layer_words(std::uint32_t layers);
/// The same as text, with commas.
std::string layers_text(std::uint32_t layers);

}  // namespace planetree::tools
