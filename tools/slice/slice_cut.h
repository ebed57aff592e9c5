#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "octree/geometry/child_bounds.h"
#include "storage/file/file_layout.h"
#include "tools/picture/drawing.h"
#include "tools/slice/slice_raster.h"

namespace planetree::tools {

/// A box in a raster, in pixels from its upper left corner.
struct PixelBox {
  double left = 0, top = 0, right = 0, bottom = 0;

  double longer_side() const { return std::max(right - left, bottom - top); }
};

/// Where a plane cuts boxes and discs of a model. Boxes and discs are in the model frame, relative
/// to the model's centre. Results are cut off at the sides of the raster.
class SliceCut {
 public:
  SliceCut(const SliceRaster& raster, const storage::ModelRecord& model);

  /// Empty if the plane or the raster does not meet the box.
  std::optional<PixelBox> of(const octree::FloatBox& box) const;
  /// Corners, in pixels of the raster, of the part of a disc that is in its box. The cylinder is
  /// cut by the planes of a prism with 24 sides around it. Empty if there is none.
  std::vector<Place> of(const octree::FloatBox& box, const octree::Disc& disc) const;

 private:
  double relative(double coordinate, unsigned axis) const;
  Place pixel(double right, double up) const;

  const SliceRaster& raster_;
  double scale_, centre_[3], plane_;  // the plane is relative to the centre
};

}  // namespace planetree::tools
