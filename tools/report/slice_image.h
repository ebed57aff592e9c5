#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/report/png_image.h"

/// Pictures of the distance to the surface over a plane.
namespace planetree::tools {

/// A plane, such as "z=1.5", a coordinate in model units, or "z=50%", a share of the model's box.
struct SlicePlane {
  unsigned axis = 2;     ///< 0, 1, 2 for x, y, z
  double value = 0;      ///< model units or per cent
  bool percent = false;  ///< whether `value` is per cent of the box, from its lower side

  /// Empty if the text is not a plane.
  static std::optional<SlicePlane> parse(std::string_view text);
  /// The coordinate in model units.
  [[nodiscard]] double coordinate(const ModelInfo& info) const;
};

/// A picture and its scale. Lengths in model units.
struct SliceImage {
  PngImage image{1, 1};
  double coordinate = 0;     ///< coordinate of the plane
  double pixel_length = 0;   ///< side of a pixel
  double line_distance = 0;  ///< difference of distance between iso-lines
  double least = 0;          ///< least distance found
  double greatest = 0;       ///< greatest distance found
};

using SliceProgress = std::function<void(std::uint64_t done, std::uint64_t total)>;

/// Draws the part of the plane in the model's box with a margin, 800 pixels on the longer side: x
/// or y to the right, z or y upward. Colours show bands of distance, iso-lines separate them, and
/// the surface is dark.
///
/// progress  called with the numbers of finished and of all pixels; may be empty
/// errors    kBadArgument for a box too large or too small to draw in double
Result<SliceImage> draw_slice(const Model& model, Probe& probe, const SlicePlane& plane,
                              const SliceProgress& progress);

}  // namespace planetree::tools
