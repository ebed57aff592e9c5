#include "tools/slice/slice_cut.h"

#include <algorithm>
#include <cmath>

#include "tools/check/disc_rim.h"

namespace planetree::tools {
namespace {

/// The places with normal . (place - origin) <= offset, where a place is in the plane of the slice.
struct HalfPlane {
  double right, up, offset;
};

// Cuts a convex polygon. Places are relative to the model's centre.
std::vector<Place> cut_off(const std::vector<Place>& polygon, const HalfPlane& half) {
  std::vector<Place> kept;
  const auto excess = [&half](const Place& at) {
    return half.right * at.x + half.up * at.y - half.offset;
  };
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Place& from = polygon[i];
    const Place& to = polygon[(i + 1) % polygon.size()];
    const double first = excess(from), second = excess(to);
    if (first <= 0) kept.push_back(from);
    if ((first < 0 && second > 0) || (first > 0 && second < 0)) {
      const double share = first / (first - second);
      kept.push_back({from.x + (to.x - from.x) * share, from.y + (to.y - from.y) * share});
    }
  }
  return kept;
}

}  // namespace

SliceCut::SliceCut(const SliceRaster& raster, const storage::ModelRecord& model)
    : raster_(raster),
      scale_(std::ldexp(1.0, model.scale_exponent)),
      centre_{model.centre[0], model.centre[1], model.centre[2]},
      plane_(relative(raster.coordinate(), raster.axis())) {}

double SliceCut::relative(double coordinate, unsigned axis) const {
  return coordinate * scale_ - centre_[axis];
}

Place SliceCut::pixel(double right, double up) const {
  const double x = (right + centre_[raster_.right()]) / scale_;
  const double y = (up + centre_[raster_.up()]) / scale_;
  return {std::clamp((x - raster_.left()) / raster_.pixel_length(), 0.0, raster_.width() + 0.0),
          std::clamp((raster_.top() - y) / raster_.pixel_length(), 0.0, raster_.height() + 0.0)};
}

std::optional<PixelBox> SliceCut::of(const octree::FloatBox& box) const {
  const unsigned axis = raster_.axis(), right = raster_.right(), up = raster_.up();
  if (!(static_cast<double>(box.lower[axis]) <= plane_ &&
        plane_ <= static_cast<double>(box.upper[axis])))
    return std::nullopt;
  const Place lower = pixel(box.lower[right], box.lower[up]);
  const Place upper = pixel(box.upper[right], box.upper[up]);
  const PixelBox cut{lower.x, upper.y, upper.x, lower.y};
  const bool is_beyond = cut.right <= 0 || cut.bottom <= 0 || cut.left >= raster_.width() ||
                         cut.top >= raster_.height();
  return is_beyond ? std::nullopt : std::optional(cut);
}

std::vector<Place> SliceCut::of(const octree::FloatBox& box, const octree::Disc& disc) const {
  if (!of(box)) return {};
  const unsigned axis = raster_.axis(), right = raster_.right(), up = raster_.up();
  const double left = box.lower[right], lower = box.lower[up];
  const double farther = box.upper[right], upper = box.upper[up];
  std::vector<Place> polygon = {{left, lower}, {farther, lower}, {farther, upper}, {left, upper}};
  const auto middle = box.centre();
  // normal . (place - middle) <= reach, of which the part across the slice is constant.
  const auto cut = [&](const std::array<double, 3>& normal, double reach) {
    const double offset = reach + normal[right] * static_cast<double>(middle[right]) +
                          normal[up] * static_cast<double>(middle[up]) -
                          normal[axis] * (plane_ - static_cast<double>(middle[axis]));
    polygon = cut_off(polygon, {normal[right], normal[up], offset});
  };
  const std::array<double, 3> normal = {disc.normal[0], disc.normal[1], disc.normal[2]};
  cut(normal, disc.slab_upper);
  cut({-normal[0], -normal[1], -normal[2]}, -static_cast<double>(disc.slab_lower));
  for (const auto& outward : rim_directions(normal)) cut(outward, disc.radius);
  for (Place& place : polygon) place = pixel(place.x, place.y);
  return polygon;
}

}  // namespace planetree::tools
