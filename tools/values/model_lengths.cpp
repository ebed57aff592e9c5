#include "tools/values/model_lengths.h"

#include <algorithm>
#include <cmath>

namespace planetree::tools {

double box_diagonal(const ModelInfo& info) {
  const double x = info.box_upper.x - info.box_lower.x, y = info.box_upper.y - info.box_lower.y,
               z = info.box_upper.z - info.box_lower.z;
  const double longest = std::max({x, y, z});
  if (!(longest > 0) || !std::isfinite(2 * longest)) return 1;
  const double a = x / longest, b = y / longest, c = z / longest;
  return longest * std::sqrt(a * a + b * b + c * c);
}

double greatest_coordinate(const ModelInfo& info) {
  double greatest = box_diagonal(info);
  for (const Vec3& corner : {info.box_lower, info.box_upper})
    for (const double value : {corner.x, corner.y, corner.z})
      greatest = std::max(greatest, std::fabs(value));
  return greatest;
}

}  // namespace planetree::tools
