#include "tools/slice/slice_arguments.h"

#include <fmt/format.h>

#include <array>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/cli/side_option.h"
#include "tools/cli/word_mask.h"
#include "tools/picture/picture_file.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMaxLevel = 255;
constexpr std::uint64_t kMaxWork = QueryOptions::kNoLimit - 1;

constexpr std::array<WordBit, 5> kOverlayWords = {{{"cells", kCellOverlay},
                                                   {"discs", kDiscOverlay},
                                                   {"pages", kPageOverlay},
                                                   {"width", kWidthOverlay},
                                                   {"residency", kResidencyOverlay}}};

std::string slice_complaint(const std::string& text) {
  if (SlicePlane::parse(text)) return {};
  return fmt::format(
      "'{}' is not a plane; give x, y or z with a number or a percentage, such as z=1.5 or z=50%",
      text);
}

std::string overlay_complaint(const std::string& text) {
  const SliceOverlays overlays = bits_of_words(text, kOverlayWords);
  if (overlays == 0)
    return fmt::format(
        "'{}' is not a list of overlays; give cells, discs, pages, width, residency or several of "
        "them, with commas",
        octree::printable(text));
  constexpr SliceOverlays kRegions = kPageOverlay | kResidencyOverlay;
  if ((overlays & kRegions) == kRegions)
    return "pages and residency colour the same places; give one of them";
  return {};
}

}  // namespace

std::vector<std::string> overlay_words(SliceOverlays overlays) {
  return words_of_bits(overlays, kOverlayWords);
}

std::string SliceOptions::complaint(const SliceArguments& arguments) const {
  const auto has = [&](SliceOverlays one) { return (arguments.overlays & one) != 0; };
  const auto given = [](SubcommandOptions::Option option) {
    return SubcommandOptions::given(option);
  };
  if (has(kDiscOverlay) != given(level))
    return has(kDiscOverlay) ? "--overlay discs requires --level"
                             : "--level requires --overlay discs";
  if (has(kResidencyOverlay) != given(trace))
    return has(kResidencyOverlay) ? "--overlay residency requires --trace"
                                  : "--trace requires --overlay residency";
  if (given(max_work) && !has(kWidthOverlay)) return "--max-work requires --overlay width";
  return {};
}

SliceOptions add_slice_options(SubcommandOptions& subcommand, SliceArguments& arguments) {
  SliceOptions options{};
  options.image = subcommand.text(
      "--image", "OUT.png|OUT.svg", picture_complaint,
      [&arguments](const std::string& text) { arguments.image = text; },
      "PNG or SVG file to write, by its extension. Metadata in it says how to read it");
  options.slice = subcommand.text(
      "--slice", "AXIS=VALUE", slice_complaint,
      [&arguments](const std::string& text) { arguments.plane = SlicePlane::parse(text); },
      "Draw instead the signed distance over a plane, such as z=1.5 (model units) or z=50% (of the "
      "box), with axes and a legend");
  options.overlay = subcommand.text(
      "--overlay", "WORDS", overlay_complaint,
      [&arguments](const std::string& text) {
        arguments.overlays = bits_of_words(text, kOverlayWords);
      },
      "Draw also, with commas between them: cells (boxes of the tree by level), discs (of one "
      "level), pages (the page of each place), residency (lookups of each page in a trace), width "
      "(of certified intervals, in place of distances)");
  options.level = subcommand.count("--level", arguments.level, kMaxLevel,
                                   "Level of the discs; the root has level 0");
  options.trace = subcommand.path("--trace", "TRACE", arguments.trace,
                                  "Page trace of the model, for residency");
  options.max_work = subcommand.count(
      "--max-work", arguments.max_work, kMaxWork,
      "Answer each pixel with at most this work, for width; see planetree query --help");
  for (const auto option : {options.overlay, options.level, options.trace, options.max_work,
                            add_side(subcommand, arguments.side_rule)})
    SubcommandOptions::need(option, options.slice);
  SubcommandOptions::need(options.slice, options.image);
  SubcommandOptions::need(options.image, options.slice);
  SubcommandOptions::need(options.level, options.overlay);
  SubcommandOptions::need(options.trace, options.overlay);
  SubcommandOptions::need(options.max_work, options.overlay);
  return options;
}

}  // namespace planetree::tools
