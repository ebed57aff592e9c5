#include "tools/compare/compare_record.h"

#include <algorithm>
#include <cstddef>

namespace planetree::tools {

double default_reach(const DeviationTally& deviations) {
  return deviations.sketch().quantile_of_magnitude(0.95);
}

ValueSketch::Histogram histogram_of(const DeviationTally& deviations) {
  constexpr std::size_t kBins = 61;  // odd, so that one is around 0
  const ValueSketch& sketch = deviations.sketch();
  double reach = sketch.quantile_of_magnitude(0.99);
  if (!(reach > 0)) reach = std::max(-sketch.min(), sketch.max());
  if (!(reach > 0)) reach = 1;
  return sketch.histogram(deviations.is_signed() ? -reach : 0, reach, kBins);
}

}  // namespace planetree::tools
