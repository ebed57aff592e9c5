#pragma once

#include <cstdint>
#include <memory>
#include <utility>

#include "tools/shapes/shape_model.h"

namespace planetree::tools {

/// A shape of which some triangles are left out, one in each of equal stretches of their order.
/// threads  any number at once
class HoledShape final : public Shape {
 public:
  /// holes  number of triangles to leave out, at most half of the shape's
  /// seed   chooses the triangle of each stretch
  HoledShape(std::unique_ptr<Shape> shape, std::uint64_t holes, std::uint64_t seed)
      : shape_(std::move(shape)), holes_(holes), seed_(seed) {}

  std::uint64_t vertex_count() const override { return shape_->vertex_count(); }
  std::uint64_t triangle_count() const override { return shape_->triangle_count() - holes_; }
  Vec3 vertex(std::uint64_t index) const override { return shape_->vertex(index); }
  std::array<std::uint64_t, 3> triangle(std::uint64_t index) const override;

 private:
  const std::unique_ptr<Shape> shape_;
  const std::uint64_t holes_;
  const std::uint64_t seed_;
};

}  // namespace planetree::tools
