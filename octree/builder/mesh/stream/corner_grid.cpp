#include "octree/builder/mesh/stream/corner_grid.h"

#include "octree/geometry/strict_math.h"

namespace planetree::octree {
namespace {

/// Cells for each unit of length; 0 where the box is too thin to be divided.
double scale_of(double length, std::size_t cells) {
  constexpr double kMinLength = 0x1p-1000;
  return length > kMinLength ? static_cast<double>(cells) / length : 0;
}

}  // namespace

void CornerGrid::start(const Box& box, std::size_t points) {
  across_ = 1;
  while (across_ * across_ < points) ++across_;
  lower_ = box.lower;
  scale_u_ = scale_of(box.upper.u - box.lower.u, across_);
  scale_v_ = scale_of(box.upper.v - box.lower.v, across_);
  first_.assign(across_ * across_, kNone);
}

void CornerGrid::add(std::uint32_t number, std::uint32_t numbers, const Position& position) {
  next_.resize(numbers);
  std::uint32_t& first = first_[row(position.v) * across_ + column(position.u)];
  next_[number] = first;
  first = number;
}

}  // namespace planetree::octree
