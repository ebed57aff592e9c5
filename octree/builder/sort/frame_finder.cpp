#include "octree/builder/sort/frame_finder.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

bool is_float(const Vec3& v) {
  return static_cast<double>(static_cast<float>(v.x)) == v.x &&
         static_cast<double>(static_cast<float>(v.y)) == v.y &&
         static_cast<double>(static_cast<float>(v.z)) == v.z;
}

}  // namespace

Triangle triangle_of(const std::array<Vec3, 3>& corners) {
  Triangle triangle;
  for (std::size_t k = 0; k < 3; ++k) triangle[k] = {corners[k].x, corners[k].y, corners[k].z};
  return triangle;
}

void FrameFinder::add(std::uint64_t index, const std::array<Vec3, 3>& corners) {
  frame_.float64 = frame_.float64 || !std::all_of(corners.begin(), corners.end(), is_float);
  if (frame_.triangle_count == 0) {
    frame_.input_sample = {corners[0].x, corners[0].y, corners[0].z};
    frame_.sample_triangle = index;
  }
  widen_box(corners);
  sample_.add(corners[0]);
  ++frame_.triangle_count;
}

void FrameFinder::widen_box(const std::array<Vec3, 3>& corners) {
  for (const Vec3& corner : corners) {
    const Point point(corner.x, corner.y, corner.z);
    const bool first = frame_.triangle_count == 0 && &corner == corners.data();
    frame_.input_lower = first ? point : Point(frame_.input_lower.cwiseMin(point));
    frame_.input_upper = first ? point : Point(frame_.input_upper.cwiseMax(point));
    for (const double value : {corner.x, corner.y, corner.z}) {
      const double magnitude = std::fabs(value);
      if (magnitude > 0 && (min_magnitude_ == 0 || magnitude < min_magnitude_))
        min_magnitude_ = magnitude;
    }
  }
}

void FrameFinder::skip(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) {
  if (frame_.skipped_count == 0) {
    frame_.first_skipped = first_index;
    frame_.first_skipped_text = why.text();
  }
  frame_.skipped_count += count;
}

void FrameFinder::choose_scale() {
  const Point &lower = frame_.input_core_lower, &upper = frame_.input_core_upper;
  // Halves, because the difference of two doubles may overflow.
  double half = (upper * 0.5 - lower * 0.5).maxCoeff();
  if (half == 0) half = std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()) * 0.5;
  int exponent = 0;
  if (half > 0) std::frexp(half, &exponent);
  frame_.scale_exponent = half > 0 ? -exponent : 0;
  frame_.stray_edge = std::ldexp(frame_.stray_edge, frame_.scale_exponent);
}

ModelFrame FrameFinder::found(const CoreFinder::Core& core) {
  frame_.input_core_lower = core.lower;
  frame_.input_core_upper = core.upper;
  frame_.stray_count = core.stray_count;
  frame_.stray_edge = core.stray_edge;
  choose_scale();
  if (min_magnitude_ > 0 &&
      std::ldexp(min_magnitude_, frame_.scale_exponent) < std::numeric_limits<float>::min())
    frame_.float64 = true;
  return std::move(frame_);
}

}  // namespace planetree::octree
