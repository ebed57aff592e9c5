#pragma once

#include <cstdint>

#include "planetree/model.h"
#include "tools/slice/slice_plane.h"

namespace planetree::tools {

/// Pixels over the part of a plane that is in the model's box, with a margin: 800 pixels on the
/// longer side, x or y to the right, z or y upward.
class SliceRaster {
 public:
  SliceRaster(const ModelInfo& info, const SlicePlane& plane);

  /// Whether pixel length and coordinate are normal, finite doubles. If not, nothing else is valid.
  bool is_usable() const;
  unsigned axis() const { return axis_; }    ///< across the plane
  unsigned right() const { return right_; }  ///< axis to the right
  unsigned up() const { return up_; }        ///< axis upward
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  double pixel_length() const { return pixel_; }     ///< side of a pixel, model units
  double coordinate() const { return coordinate_; }  ///< of the plane
  double left() const { return left_; }              ///< coordinate of the left side
  double top() const { return top_; }                ///< coordinate of the upper side

  /// Middle of a pixel, in model units.
  Vec3 centre(std::uint32_t column, std::uint32_t row) const;

 private:
  unsigned axis_, right_, up_;
  double coordinate_;
  double pixel_ = 0;
  std::uint32_t width_ = 1, height_ = 1;
  double left_ = 0, top_ = 0;
};

}  // namespace planetree::tools
