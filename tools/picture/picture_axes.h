#pragma once

#include <cstdint>

#include "tools/picture/drawing.h"

namespace planetree::tools {

/// Where a raster lies in a picture and in coordinates.
struct RasterFrame {
  std::uint32_t left = 0, top = 0, width = 1, height = 1;  ///< in pixels
  char right_axis = 'x', up_axis = 'y';                    ///< names of the axes
  double left_coordinate = 0, top_coordinate = 0;          ///< of the raster's upper left corner
  double pixel_length = 1;
};

/// Room that the axis to the right takes below a raster, in pixels.
inline constexpr std::uint32_t kLowerRoom = 88;

/// Room that the upward axis takes to the left of a raster, in pixels. `frame.left` does not
/// matter.
[[nodiscard]] std::uint32_t left_room(const RasterFrame& frame);

/// Draws a frame around the raster, axes with ticks and names, and a scale bar with its length.
void draw_axes(const RasterFrame& frame, Drawing& drawing);

}  // namespace planetree::tools
