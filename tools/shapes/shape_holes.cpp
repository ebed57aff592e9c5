#include "tools/shapes/shape_holes.h"

#include "tools/shapes/shape_noise.h"

namespace planetree::tools {

std::array<std::uint64_t, 3> HoledShape::triangle(std::uint64_t index) const {
  if (holes_ == 0) return shape_->triangle(index);
  // What is behind the last stretch is whole.
  const std::uint64_t size = shape_->triangle_count() / holes_, kept = size - 1;
  const std::uint64_t stretch = index / kept, within = index % kept;
  if (stretch >= holes_) return shape_->triangle(index + holes_);
  const std::uint64_t hole = mixed_bits(seed_ ^ mixed_bits(stretch)) % size;
  return shape_->triangle(stretch * size + within + (within >= hole ? 1 : 0));
}

}  // namespace planetree::tools
