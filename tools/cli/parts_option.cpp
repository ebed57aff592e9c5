#include "tools/cli/parts_option.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/word_mask.h"

namespace planetree::tools {
namespace {

constexpr std::array<WordBit, 3> kWords = {
    {{"distance", kDistance}, {"side", kSide}, {"normal", kNormal}}};

std::string complaint_of(const std::string& text) {
  if (bits_of_words(text, kWords) != 0) return {};
  return fmt::format(
      "'{}' is not a list of parts; give distance, side, normal or several of them, with commas",
      octree::printable(text));
}

}  // namespace

std::vector<std::string> part_words(std::uint32_t parts) { return words_of_bits(parts, kWords); }

std::string parts_text(std::uint32_t parts) {
  return fmt::format("{}", fmt::join(part_words(parts), ","));
}

SubcommandOptions::Option add_parts(SubcommandOptions& subcommand,
                                    std::function<void(std::uint32_t)> take,
                                    const std::string& help) {
  const auto parts = subcommand.text(
      "--parts", "PARTS", complaint_of,
      [take = std::move(take)](const std::string& text) { take(bits_of_words(text, kWords)); },
      "Compute only these parts, to save time: distance (with interval, nearest point, triangle "
      "and feature), side, normal (needs the others and includes them), with commas between "
      "them. " +
          help);
  return SubcommandOptions::default_text(
      parts, parts_text(kAllParts) + ", or what --layers leaves of them");
}

}  // namespace planetree::tools
