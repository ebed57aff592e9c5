#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "tools/thickness/thickness_search.h"
#include "tools/values/value_sketch.h"

namespace planetree::tools {

/// What a measurement of thickness found.
struct ThicknessRecord {
  static constexpr std::array<int, 5> kPercents = {1, 5, 50, 95, 99};

  std::string file;    ///< of the model
  std::string points;  ///< where it was measured; empty: at the middles of triangles
  std::uint64_t model_triangles = 0;
  double diagonal = 0;  ///< of the model's box
  ThicknessOptions options;
  std::optional<double> thin;  ///< what is thinner is counted

  std::uint64_t count = 0;
  std::array<std::uint64_t, kThicknessStatuses> by_status{};
  /// Of the points that have a wall within the maximum thickness, as all that follows.
  ValueSketch sketch;
  double sum = 0;             ///< of thickness times weight
  WallThickness thinnest;     ///< the first of the least thickness, if there is one
  std::uint64_t thinner = 0;  ///< points below `thin`
  double weight_of_thinner = 0;
  double widest_interval = 0;  ///< greatest upper end minus lower end
  double seconds = 0;
  std::uint64_t memory_bytes = 0;

  /// Takes a point.
  ///
  /// weight  of the point, such as the area that it stands for
  void add(const WallThickness& wall, double weight);

  std::uint64_t count_of(ThicknessStatus status) const {
    return by_status[static_cast<std::size_t>(status)];
  }
  double mean() const { return sketch.weight() > 0 ? sum / sketch.weight() : 0; }
  double share_thinner() const {
    return sketch.weight() > 0 ? weight_of_thinner / sketch.weight() : 0;
  }
  /// The thicknesses from 0 to the 99th percentile in equal bins.
  ValueSketch::Histogram histogram() const;
};

}  // namespace planetree::tools
