#include "octree/builder/sort/core_box.h"

#include <algorithm>
#include <cmath>

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Share of the sample that is left out on each side of each axis: one in so many.
constexpr std::size_t kTrimmed = 64;
/// The core is looked for within so many lengths of the middle of the sample, on each side.
constexpr double kWindowMargin = 2;
/// Strays are told from the core only if the model is so many times as long as the middle of the
/// sample, and so many times as long as the core.
constexpr double kMinModelPerMiddle = 16, kMinModelPerCore = 4;
/// Greatest coordinate, in lengths of the core. Coordinates in the model frame are then below
/// kMaxCoordinate.
constexpr double kMaxCoordinatePerCore = 0x1p110;
/// Longest edge, in lengths of the core, of a stray triangle that is longer than its gap to the
/// core. It makes bounds less certain by a share of 2^-40 of its edge (bound_slack()).
constexpr double kMaxEdgePerCore = 0x1p20;

double longest_edge(const Point& lower, const Point& upper) { return (upper - lower).maxCoeff(); }

}  // namespace

void CornerSample::add(const Vec3& corner) {
  if ((added_++ & (step_ - 1)) != 0) return;
  if (corners_.size() == kMaxCorners) {
    for (std::size_t i = 0; 2 * i < corners_.size(); ++i) corners_[i] = corners_[2 * i];
    corners_.resize(kMaxCorners / 2);
    step_ *= 2;
  }
  corners_.push_back({corner.x, corner.y, corner.z});
}

bool CornerSample::middle(Middle& found) const {
  const std::size_t trimmed = corners_.size() / kTrimmed;
  if (trimmed == 0) return false;
  std::vector<double> values(corners_.size());
  for (unsigned axis = 0; axis < 3; ++axis) {
    std::transform(corners_.begin(), corners_.end(), values.begin(),
                   [axis](const std::array<double, 3>& corner) { return corner[axis]; });
    const auto least = values.begin() + static_cast<std::ptrdiff_t>(trimmed);
    std::nth_element(values.begin(), least, values.end());
    found.lower[axis] = *least;
    const auto greatest = values.end() - static_cast<std::ptrdiff_t>(trimmed + 1);
    std::nth_element(values.begin(), greatest, values.end());
    found.upper[axis] = *greatest;
  }
  return true;
}

CoreFinder::CoreFinder(const CornerSample& sample, const Point& lower, const Point& upper)
    : model_lower_(lower), model_upper_(upper) {
  CornerSample::Middle middle{Point::Zero(), Point::Zero()};
  if (!sample.middle(middle)) return;
  const double edge = longest_edge(middle.lower, middle.upper);
  const double margin = kWindowMargin * edge;
  window_lower_ = middle.lower.array() - margin;
  window_upper_ = middle.upper.array() + margin;
  // False if any of them is infinite.
  may_have_strays_ = edge > 0 && longest_edge(lower, upper) > kMinModelPerMiddle * edge &&
                     std::isfinite(longest_edge(lower, upper));
}

void CoreFinder::add(const Triangle& triangle) {
  const Point least = least_corner(triangle), greatest = greatest_corner(triangle);
  if ((least.array() >= window_lower_.array()).all() &&
      (greatest.array() <= window_upper_.array()).all()) {
    core_.lower = core_count_ == 0 ? least : Point(core_.lower.cwiseMin(least));
    core_.upper = core_count_ == 0 ? greatest : Point(core_.upper.cwiseMax(greatest));
    ++core_count_;
    return;
  }
  ++core_.stray_count;
  // The sum of a box's edges is not less than any edge of the triangle.
  const double edge = (greatest - least).sum();
  const double gap = (least - window_upper_).cwiseMax(window_lower_ - greatest).maxCoeff();
  if (gap < edge) core_.stray_edge = std::max(core_.stray_edge, edge);
}

CoreFinder::Core CoreFinder::found() const {
  const double edge = longest_edge(core_.lower, core_.upper);
  const double farthest =
      std::max(model_lower_.cwiseAbs().maxCoeff(), model_upper_.cwiseAbs().maxCoeff());
  const bool taken =
      core_.stray_count > 0 && edge > 0 && core_count_ / kTrianglesPerStray >= core_.stray_count &&
      longest_edge(model_lower_, model_upper_) > kMinModelPerCore * edge &&
      farthest < kMaxCoordinatePerCore * edge && core_.stray_edge < kMaxEdgePerCore * edge;
  return taken ? core_ : Core{model_lower_, model_upper_, 0, 0};
}

}  // namespace planetree::octree
