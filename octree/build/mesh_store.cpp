#include "octree/build/mesh_store.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "octree/strict_math.h"

namespace planetree::octree {

Result<void> MeshStore::triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) {
  if (count_ == std::numeric_limits<std::uint32_t>::max())
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "more than 4294967295 triangles; split the model");
  const std::uint64_t skipped = index - count_;
  if (skipped != (gaps_.empty() ? 0 : gaps_.back().skipped)) gaps_.push_back({count_, skipped});
  for (const Vec3& corner : corners) {
    const Point point(corner.x, corner.y, corner.z);
    const bool first = count_ == 0 && &corner == corners.data();
    input_lower_ = first ? point : Point(input_lower_.cwiseMin(point));
    input_upper_ = first ? point : Point(input_upper_.cwiseMax(point));
    for (const double value : {corner.x, corner.y, corner.z}) {
      const double magnitude = std::fabs(value);
      if (magnitude > 0 && (least_magnitude_ == 0 || magnitude < least_magnitude_))
        least_magnitude_ = magnitude;
      if (!float64_ && static_cast<double>(static_cast<float>(value)) != value) widen();
      if (float64_)
        wide_.push_back(value);
      else
        narrow_.push_back(static_cast<float>(value));
    }
  }
  ++count_;
  return {};
}

void MeshStore::set_aside(std::uint64_t first_index, std::uint64_t count, const SetAside& why) {
  if (set_aside_count_ == 0) {
    first_set_aside_ = first_index;
    first_set_aside_text_ = why.text();
  }
  set_aside_count_ += count;
}

void MeshStore::progress(std::uint64_t bytes_done, std::uint64_t bytes_total) {
  if (progress_) progress_(progress_context_, bytes_done, bytes_total);
}

void MeshStore::widen() {
  wide_.assign(narrow_.begin(), narrow_.end());
  narrow_ = {};
  float64_ = true;
}

void MeshStore::choose_scale() {
  // Halves, because the difference of two doubles may overflow.
  double half = (input_upper_ * 0.5 - input_lower_ * 0.5).maxCoeff();
  if (half == 0)
    half = std::max(input_lower_.cwiseAbs().maxCoeff(), input_upper_.cwiseAbs().maxCoeff()) * 0.5;
  int exponent = 0;
  if (half > 0) std::frexp(half, &exponent);
  scale_exponent_ = half > 0 ? -exponent : 0;
}

void MeshStore::normalise() {
  choose_scale();
  if (!float64_ && least_magnitude_ > 0 &&
      std::ldexp(least_magnitude_, scale_exponent_) < std::numeric_limits<float>::min())
    widen();
  for (float& value : narrow_)
    value = static_cast<float>(std::ldexp(static_cast<double>(value), scale_exponent_));
  // What underflows may become -0, which is another position bit by bit; adding 0 makes it +0.
  for (double& value : wide_) value = std::ldexp(value, scale_exponent_) + 0.0;
}

Triangle MeshStore::corners(std::uint32_t position) const {
  const std::size_t at = std::size_t{9} * position;
  Triangle triangle;
  for (std::size_t corner = 0; corner < 3; ++corner)
    for (std::size_t axis = 0; axis < 3; ++axis)
      triangle[corner][static_cast<Eigen::Index>(axis)] =
          float64_ ? wide_[at + 3 * corner + axis]
                   : static_cast<double>(narrow_[at + 3 * corner + axis]);
  return triangle;
}

std::uint64_t MeshStore::index(std::uint32_t position) const {
  const auto after =
      std::upper_bound(gaps_.begin(), gaps_.end(), position,
                       [](std::uint64_t value, const Gap& gap) { return value < gap.position; });
  return position + (after == gaps_.begin() ? 0 : std::prev(after)->skipped);
}

Point MeshStore::lower() const {
  return input_lower_.unaryExpr([this](double v) { return std::ldexp(v, scale_exponent_); });
}

Point MeshStore::upper() const {
  return input_upper_.unaryExpr([this](double v) { return std::ldexp(v, scale_exponent_); });
}

}  // namespace planetree::octree
