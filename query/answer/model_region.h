#pragma once

#include "octree/geometry/region.h"
#include "query/answer/scale.h"
#include "storage/file/file_layout.h"

namespace planetree::query {

/// Where a file knows all of the surface; model frame.
inline octree::Region region_of(const storage::ModelRecord& model) {
  if (!model.has_region()) return {};
  const Scale scale(model.scale_exponent);
  const auto point = [&scale](const double(&v)[3]) { return scale.in(Vec3{v[0], v[1], v[2]}); };
  return {point(model.region_lower), point(model.region_upper), point(model.box_lower),
          point(model.box_upper)};
}

}  // namespace planetree::query
