#include "octree/builder/mesh/stream/corner_grid.h"

#include <cmath>

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

// Rounding moves the part of a side within a row by far less than a column, unless the side hardly
// rises: then all of it is taken.
CornerGrid::Columns CornerGrid::columns_of(const std::array<Position, 3>& triangle, const Box& box,
                                           std::size_t row) const {
  constexpr double kMargin = 0x1p-16;  // in rows
  const Columns all = {column(box.lower.u), column(box.upper.u)};
  if (scale_v_ == 0 || all.last - all.first < 4) return all;
  const double from = static_cast<double>(row) - kMargin,
               to = static_cast<double>(row + 1) + kMargin;
  double least = box.upper.u - lower_.u, most = box.lower.u - lower_.u;
  for (std::size_t k = 0; k < 3; ++k) {
    const Position &p = triangle[k], &q = triangle[(k + 1) % 3];
    const double pu = p.u - lower_.u, qu = q.u - lower_.u;
    const double pv = (p.v - lower_.v) * scale_v_, qv = (q.v - lower_.v) * scale_v_;
    if (std::max(pv, qv) < from || std::min(pv, qv) > to) continue;
    const bool is_level = std::fabs(qv - pv) < kMargin;
    for (const double end : {from, to}) {
      const double share =
          is_level ? (end == from ? 0 : 1) : std::clamp((end - pv) / (qv - pv), 0.0, 1.0);
      const double u = pu + share * (qu - pu);
      least = std::min(least, u);
      most = std::max(most, u);
    }
  }
  if (least > most) return all;
  const std::size_t first = cell(std::max(least, 0.0), scale_u_);
  const std::size_t last = cell(std::max(most, 0.0), scale_u_);
  return {std::max(first, all.first + 1) - 1, std::min(last + 1, all.last)};
}

}  // namespace planetree::octree
