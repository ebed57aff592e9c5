#pragma once

#include <string>

namespace planetree::tools {

/// The shape of a point in a plot, so that series differ by more than their colours.
enum class PlotShape { kCircle, kSquare, kDiamond, kTriangle, kDownTriangle, kPlus };

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
    case PlotShape::kDownTriangle:
      return "M0 5.6 5.6-4.4h-11.2Z";
    case PlotShape::kPlus:
      return "M-1.8-5.2h3.6v3.4h3.4v3.6h-3.4v3.4h-3.6v-3.4h-3.4v-3.6h3.4Z";
  }
  return "";
}

}  // namespace planetree::tools
