#include "tools/slice/slice_raster.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace planetree::tools {
namespace {

constexpr double kLongSidePixels = 800;
constexpr double kMarginShare = 0.08;  // margin on each side, as a share of the longer side

}  // namespace

SliceRaster::SliceRaster(const ModelInfo& info, const SlicePlane& plane)
    : axis_(plane.axis),
      right_(plane.axis == 0 ? 1 : 0),
      up_(plane.axis == 2 ? 1 : 2),
      coordinate_(plane.coordinate(info)) {
  const auto length = [&info](unsigned axis) {
    return component(info.core_upper, axis) - component(info.core_lower, axis);
  };
  double longer = std::max(length(right_), length(up_));
  if (!(longer > 0)) longer = length(axis_) > 0 ? length(axis_) : 1;
  pixel_ = longer * (1 + 2 * kMarginShare) / kLongSidePixels;
  if (!is_usable()) return;
  const auto pixels = [&](unsigned axis) {
    const double count = std::ceil((length(axis) + 2 * kMarginShare * longer) / pixel_ - 0.001);
    return static_cast<std::uint32_t>(std::clamp(count, 1.0, kLongSidePixels));
  };
  width_ = pixels(right_);
  height_ = pixels(up_);
  const auto middle = [&info](unsigned axis) {
    return component(info.core_lower, axis) / 2 + component(info.core_upper, axis) / 2;
  };
  left_ = middle(right_) - pixel_ * width_ / 2;
  top_ = middle(up_) + pixel_ * height_ / 2;
}

bool SliceRaster::is_usable() const { return std::isnormal(pixel_) && std::isfinite(coordinate_); }

Vec3 SliceRaster::centre(std::uint32_t column, std::uint32_t row) const {
  std::array<double, 3> at{};
  at[axis_] = coordinate_;
  at[right_] = left_ + pixel_ * (column + 0.5);
  at[up_] = top_ - pixel_ * (row + 0.5);
  return {at[0], at[1], at[2]};
}

}  // namespace planetree::tools
