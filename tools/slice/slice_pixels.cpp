#include "tools/slice/slice_pixels.h"

#include <algorithm>
#include <cmath>

namespace planetree::tools {
namespace {

constexpr double kSurfacePixels = 0.7;  // half the width of the surface's stroke

/// The share of a pixel that a stroke covers. `half` is half of the stroke's width, `away` the
/// distance of its middle from the pixel's centre; both in pixels.
double coverage(double away, double half) { return std::clamp(half + 0.5 - away, 0.0, 1.0); }

// How dark the iso-line at a distance makes a pixel. The line at 0 is the surface.
double iso_line_share(double distance, double line_distance, double pixel_length) {
  const double line = std::round(distance / line_distance);
  if (!(line > 0)) return 0;
  const bool strong = std::fmod(line, 5) == 0;
  const double away = std::fabs(distance - line * line_distance) / pixel_length;
  return coverage(away, strong ? 0.4 : 0.1) * (strong ? 0.55 : 0.3);
}

}  // namespace

PngImage slice_pixels(const SliceContents& contents) {
  const SliceRaster& raster = contents.raster;
  const SliceScales& scales = contents.scales;
  const bool shows_width = (contents.arguments.overlays & kWidthOverlay) != 0;
  PngImage image(raster.width(), raster.height());
  for (std::uint32_t row = 0; row < raster.height(); ++row)
    for (std::uint32_t column = 0; column < raster.width(); ++column) {
      const std::size_t at = std::size_t{row} * raster.width() + column;
      const PixelAnswer& answer = contents.answers[at];
      Rgb colour = scales.colour(answer);
      if (contents.page_map && contents.page_map->pages[at] != PageMap::kNone)
        colour = contents.pages.at(contents.page_map->pages[at]).colour;
      if (contents.page_map && contents.page_map->is_border(column, row))
        colour = mix(colour, kInk, 0.45);
      if (std::isfinite(answer.distance)) {
        const double pixel = raster.pixel_length();
        if (!shows_width)
          colour =
              mix(colour, kInk, iso_line_share(answer.distance, scales.line_distance(), pixel));
        colour = mix(colour, kInk, coverage(answer.distance / pixel, kSurfacePixels));
      }
      image.at(column, row) = colour;
    }
  return image;
}

}  // namespace planetree::tools
