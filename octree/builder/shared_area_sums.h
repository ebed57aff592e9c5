#pragma once

#include <cstdint>
#include <mutex>

#include "octree/builder/sort/triangles.h"
#include "octree/geometry/area_sums.h"

namespace planetree::octree {

/// AreaSums of a surface whose parts any number of threads add.
class SharedAreaSums {
 public:
  /// lower, upper  the core, model frame
  SharedAreaSums(const Point& lower, const Point& upper)
      : lower_(lower), upper_(upper), sums_(lower, upper) {}

  /// Adds a part of the model, each part once.
  void add(const Triangles& part) {
    AreaSums sums(lower_, upper_);
    for (std::uint32_t i = 0; i < part.size(); ++i) sums.add(part.corners(i));
    const std::lock_guard lock(mutex_);
    sums_.add(sums);
  }

  /// Adds sums of parts that were stored.
  void add(const AreaSums::Words& words) {
    const std::lock_guard lock(mutex_);
    sums_.add(words);
  }

  /// The sums, to be stored. Call it after the last part.
  AreaSums::Words words() const { return sums_.words(); }
  /// Returns AreaSums::openness(). Call it after the last part.
  double openness() const { return sums_.openness(); }

 private:
  const Point lower_, upper_;
  std::mutex mutex_;
  AreaSums sums_;
};

}  // namespace planetree::octree
