#include "tools/compare/mesh_comparison.h"

#include <cstdint>
#include <limits>

namespace planetree::tools {
void MeshComparison::weigh(const MeshPiece& piece) {
  // Above 0, so that a mesh without area has statistics too.
  weights_.assign(piece.corners.size(), std::numeric_limits<double>::min());
  for (const auto& triangle : piece.triangles) {
    const auto& [a, b, c] = triangle;
    const double third = area_of({piece.corners[a], piece.corners[b], piece.corners[c]}, unit_) / 3;
    for (const std::uint32_t corner : triangle) weights_[corner] += third;
  }
}

Result<void> MeshComparison::take(const MeshPiece& piece) {
  answers_.resize(piece.corners.size());
  values_.resize(piece.corners.size());
  probe_.closest_points(piece.corners, answers_, options_);
  weigh(piece);
  for (std::size_t i = 0; i < piece.corners.size(); ++i)
    values_[i] = deviations_.add(piece.corners[i], answers_[i], weights_[i]);
  if (const auto added = search_.add(piece, answers_); !added) return added;
  return cloud_ != nullptr ? draw(piece, values_) : Result<void>();
}

Result<void> MeshComparison::draw(const MeshPiece& piece, std::span<const double> deviations) {
  const std::uint64_t first = cloud_->point_count();
  for (std::size_t i = 0; i < piece.corners.size(); ++i)
    if (const auto added = cloud_->add(piece.corners[i], deviations[i]); !added) return added;
  for (const auto& [a, b, c] : piece.triangles)
    if (const auto added = cloud_->add_triangle({first + a, first + b, first + c}); !added)
      return added;
  return {};
}

}  // namespace planetree::tools
