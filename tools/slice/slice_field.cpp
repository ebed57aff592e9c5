#include "tools/slice/slice_field.h"

#include <algorithm>

namespace planetree::tools {
namespace {

constexpr double kErrorPixels = 0.05;  // tolerance of distances, too small to be visible
constexpr std::uint32_t kRows = 64;    // queried together, enough for a good order

QueryOptions query_options(const SliceRaster& raster, const SliceArguments& arguments) {
  QueryOptions options;
  options.parts = kDistance | kSide;
  options.side_rule = arguments.side_rule;
  if ((arguments.overlays & kWidthOverlay) == 0)
    options.max_error = raster.pixel_length() * kErrorPixels;
  options.max_work = static_cast<std::uint32_t>(arguments.max_work);
  return options;
}

}  // namespace

std::vector<PixelAnswer> slice_field(const SliceRaster& raster, Probe& probe,
                                     const SliceArguments& arguments,
                                     const SliceProgress& progress) {
  const QueryOptions options = query_options(raster, arguments);
  const std::size_t total = std::size_t{raster.width()} * raster.height();
  std::vector<PixelAnswer> found;
  found.reserve(total);
  if (progress) progress(0, total);
  std::vector<Vec3> points;
  std::vector<ClosestPoint> answers;
  for (std::uint32_t first = 0; first < raster.height(); first += kRows) {
    points.clear();
    for (std::uint32_t row = first; row < std::min(first + kRows, raster.height()); ++row)
      for (std::uint32_t column = 0; column < raster.width(); ++column)
        points.push_back(raster.centre(column, row));
    answers.resize(points.size());
    probe.closest_points(points, answers, options);
    for (const ClosestPoint& answer : answers)
      found.push_back({answer.distance, answer.upper - answer.lower, answer.side});
    if (progress) progress(found.size(), total);
  }
  return found;
}

}  // namespace planetree::tools
