#include "tools/cli/layer_words.h"

#include <fmt/format.h>

#include <array>

#include "tools/cli/word_mask.h"

namespace planetree::tools {
namespace {

constexpr std::array<WordBit, 4> kWords = {{{"distance", kDistanceLayer},
                                            {"side", kSideLayer},
                                            {"field", kFieldLayer},
                                            {"attributes", kAttributeLayer}}};

}  // namespace

std::uint32_t layers_of(const std::string& text) {
  const std::uint32_t layers = bits_of_words(text, kWords);
  return layers == 0 ? 0 : layers | kDistanceLayer;
}

std::vector<std::string> layer_words(std::uint32_t layers) { return words_of_bits(layers, kWords); }

std::string layers_text(std::uint32_t layers) {
  return fmt::format("{}", fmt::join(layer_words(layers), ","));
}

}  // namespace planetree::tools
