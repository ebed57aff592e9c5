#include "tools/thickness/thickness_record.h"

#include <algorithm>

namespace planetree::tools {

void ThicknessRecord::add(const WallThickness& wall, double weight) {
  ++count;
  ++by_status[static_cast<std::size_t>(wall.status)];
  if (!wall.has_contact) return;
  if (thinnest.status == ThicknessStatus::kBadPoint || wall.thickness < thinnest.thickness)
    thinnest = wall;
  sketch.add(wall.thickness, weight);
  sum += weight * wall.thickness;
  widest_interval = std::max(widest_interval, wall.upper - wall.lower);
  if (!thin || wall.thickness >= *thin) return;
  ++thinner;
  weight_of_thinner += weight;
}

ValueSketch::Histogram ThicknessRecord::histogram() const {
  constexpr std::size_t kBins = 60;
  const double most = sketch.quantile(0.99);
  return sketch.histogram(0, most > 0 ? most : 1, kBins);
}

}  // namespace planetree::tools
