#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/report/png_image.h"

/// The distance to the surface over a plane through the model, as a picture.
namespace planetree::tools {

/// "z=1.5": a coordinate in model units; "z=50%": a share of the model's box.
struct SlicePlane {
  unsigned axis = 2;  ///< 0, 1, 2 for x, y, z
  double value = 0;
  bool percent = false;

  static std::optional<SlicePlane> parse(std::string_view text);
  /// The coordinate in model units.
  [[nodiscard]] double coordinate(const ModelInfo& info) const;
};

struct SliceImage {
  PngImage image{1, 1};
  double coordinate = 0;     ///< of the plane, model units
  double pixel_length = 0;   ///< model units
  double line_distance = 0;  ///< between iso-lines, model units
  double least = 0;          ///< distance found, model units
  double greatest = 0;
};

using SliceProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// Draws the box's part of the plane and a margin, 800 pixels on the longer
/// side: x or y to the right, z or y upward. Colour tells the distance in
/// bands, lines part them, the surface itself is dark.
///
/// progress  may be empty; told how many pixels of how many are answered
/// errors    kBadArgument for a box that has no length double can tell
Result<SliceImage> draw_slice(const Model& model, Probe& probe, const SlicePlane& plane,
                              const SliceProgress& progress);

}  // namespace planetree::tools
