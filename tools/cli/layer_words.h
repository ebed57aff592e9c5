#pragma once

#include <fmt/format.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "planetree/layers.h"
#include "tools/cli/word_mask.h"

namespace planetree::tools {

/// Words of the layers of a file.
inline constexpr std::array<WordBit, 4> kLayerWords = {{{"distance", kDistanceLayer},
                                                        {"side", kSideLayer},
                                                        {"field", kFieldLayer},
                                                        {"attributes", kAttributeLayer}}};

/// Returns the layers in a list of their words, such as "distance,side", with the distance layer. 0
/// if it is no such list.
inline std::uint32_t layers_of(const std::string& text) {
  const std::uint32_t layers = bits_of_words(text, kLayerWords);
  return layers == 0 ? 0 : layers | kDistanceLayer;
}

/// Returns the words of layers, in the order distance, side, field, attributes.
inline std::vector<std::string> layer_words(std::uint32_t layers) {
  return words_of_bits(layers, kLayerWords);
}

/// The same as text, with commas.
inline std::string layers_text(std::uint32_t layers) {
  return fmt::format("{}", fmt::join(layer_words(layers), ","));
}

}  // namespace planetree::tools
