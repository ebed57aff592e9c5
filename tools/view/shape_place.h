#pragma once

#include <cstddef>

#include "octree/geometry/rigid_transform.h"
#include "planetree/pose.h"
#include "storage/file/file_layout.h"
#include "tools/view/view_request.h"

namespace planetree::tools {

/// The frame of shapes: a point is at (point - centre) / unit, so that floats suffice.
struct ShapeFrame {
  Vec3 centre;
  double unit = 1;

  /// The frame of the shape of one file: its model frame, relative to the model's centre.
  static ShapeFrame of(const storage::FileHeader& header);
  /// A frame in which a box lies about the origin. Its longest edge is 1 to 2, if it has one.
  static ShapeFrame about(const Vec3& lower, const Vec3& upper);
};

/// Where the shape of a file is in the frame of a picture: scaled, turned and moved.
class ShapePlace {
 public:
  /// The place of a file that is shown in its own frame.
  ShapePlace() = default;
  /// The place of an instance.
  ///
  /// pose  valid; of the instance
  /// own   frame of the instance's file
  /// all   frame of the picture
  ShapePlace(const Pose& pose, const ShapeFrame& own, const ShapeFrame& all);

  /// The same view in the frame of the file.
  ShapeView view_from(const ShapeView& view) const;
  /// A point at p in the frame of the file is at offset() + scale() * rotation() * p in that of the
  /// picture.
  double scale() const { return scale_; }
  const Quaternion& rotation() const { return rotation_; }
  const Vec3& offset() const { return turn_.translation(); }

 private:
  double scale_ = 1;
  Quaternion rotation_;
  octree::RigidTransform turn_ = *octree::RigidTransform::of({});
};

}  // namespace planetree::tools
