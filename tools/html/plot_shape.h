#pragma once

#include <string>

namespace planetree::tools {

/// The shape of a point in a plot, so that series differ by more than their colours.
enum class PlotShape { kCircle, kSquare, kDiamond, kTriangle };

/// Half the edge length of the square that a shape fits, in units of the drawing.
inline constexpr double kPlotShapeReach = 6;

/// The path of a shape around (0, 0).
constexpr const char* path_of(PlotShape shape) {
  switch (shape) {
    case PlotShape::kCircle:
      return "M-4.8 0a4.8 4.8 0 1 0 9.6 0a4.8 4.8 0 1 0-9.6 0Z";
    case PlotShape::kSquare:
      return "M-4.3-4.3h8.6v8.6h-8.6Z";
    case PlotShape::kDiamond:
      return "M0-6 6 0 0 6-6 0Z";
    case PlotShape::kTriangle:
      return "M0-5.6 5.6 4.4h-11.2Z";
  }
  return "";
}

}  // namespace planetree::tools
