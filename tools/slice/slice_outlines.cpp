#include "tools/slice/slice_outlines.h"

#include <algorithm>

#include "tools/check/tree_descent.h"
#include "tools/picture/band_scale.h"

namespace planetree::tools {
namespace {

constexpr double kMinCellPixels = 4;
constexpr double kMinDiscPixels = 2;
constexpr Rgb kDiscColour = {190, 20, 130};

// From purple by blue to green: of no hue that distances outside or inside have alone.
constexpr ColourRamp kLevelColours = {Rgb{137, 2, 98},  Rgb{132, 17, 147}, Rgb{113, 49, 184},
                                      Rgb{81, 75, 210}, Rgb{5, 126, 173},  Rgb{5, 152, 146},
                                      Rgb{32, 179, 57}};

std::vector<Place> corners_of(const PixelBox& box) {
  return {
      {box.left, box.top}, {box.right, box.top}, {box.right, box.bottom}, {box.left, box.bottom}};
}

void add_outline(std::vector<Place> corners, LevelOutlines& outlines) {
  ++outlines.count;
  outlines.stroke.paths.push_back(std::move(corners));
}

}  // namespace

Result<std::vector<LevelOutlines>> cell_outlines(FileParts& parts, const SliceCut& cut) {
  std::vector<LevelOutlines> levels;
  const auto visit = [&](const TreePart& part) {
    const auto box = cut.of(part.box);
    if (!box || box->longer_side() < kMinCellPixels) return false;
    if (part.is_only_child) return true;  // its box is drawn already
    if (levels.size() <= part.depth) levels.resize(part.depth + 1);
    add_outline(corners_of(*box), levels[part.depth]);
    return true;
  };
  if (const auto done = descend_tree(parts, visit, {}); !done) return done.error();
  for (std::uint32_t i = 0; i < levels.size(); ++i) {
    LevelOutlines& each = levels[i];
    each.level = i;
    const auto steps = static_cast<double>(std::max<std::size_t>(levels.size() - 1, 1));
    each.colour = ramp_colour(kLevelColours, i / steps);
    each.stroke.is_closed = true;
    each.stroke.colour = each.colour;
    each.stroke.width = std::max(1.0, 2.2 - 0.3 * i);
  }
  return levels;
}

Result<LevelOutlines> disc_outlines(FileParts& parts, const SliceCut& cut, std::uint32_t level) {
  LevelOutlines outlines{level, kDiscColour, 0, 0, {{}, true, kDiscColour, 1.4}};
  const auto visit = [&](const TreePart& part) {
    const auto box = cut.of(part.box);
    if (!box) return false;
    if (box->longer_side() < kMinDiscPixels) {
      ++outlines.left_out;
      return false;
    }
    if (part.depth < level && !part.is_block) return true;
    if (!part.has_disc) return false;
    std::vector<Place> corners = cut.of(part.box, part.disc);
    if (corners.size() > 1) add_outline(std::move(corners), outlines);
    return false;
  };
  if (const auto done = descend_tree(parts, visit, {}); !done) return done.error();
  return outlines;
}

}  // namespace planetree::tools
