#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tools/compare/deviation_tally.h"
#include "tools/values/colour_scale.h"
#include "tools/values/value_sketch.h"

namespace planetree::tools {

/// What is known of a mesh that was compared.
struct ComparedMesh {
  std::uint64_t triangles = 0;
  std::uint64_t skipped = 0;     ///< triangles of records that cannot be used
  double spacing = 0;            ///< longest edge of the parts that its triangles were cut into
  std::uint64_t splits = 0;      ///< of parts, for the greatest distance
  bool is_within_error = false;  ///< whether that is as narrow as allowed
  double allowed_error = 0;      ///< of that
};

/// What a comparison found.
struct CompareRecord {
  std::string file;   ///< of the model
  std::string other;  ///< what was compared with it
  std::uint64_t model_triangles = 0;
  double diagonal = 0;  ///< of the model's box
  DeviationTally deviations;
  std::optional<ComparedMesh> mesh;  ///< empty: points were compared
  HausdorffInterval hausdorff;
  double reach = 0;  ///< deviation of the darkest colours
  double seconds = 0;
  std::uint64_t memory_bytes = 0;
  std::uint64_t pages_read = 0;
};

/// The deviation of the darkest colours if none is given: the 95th percentile of the magnitudes.
[[nodiscard]] double default_reach(const DeviationTally& deviations);

/// The deviations in equal bins, around 0 if they have signs, out to the 99th percentile of the
/// magnitudes.
[[nodiscard]] ValueSketch::Histogram histogram_of(const DeviationTally& deviations);

}  // namespace planetree::tools
