#pragma once

#include <span>
#include <vector>

#include "planetree/probe.h"
#include "tools/compare/deviation_tally.h"
#include "tools/compare/hausdorff_search.h"
#include "tools/mesh/mesh_pieces.h"
#include "tools/values/coloured_cloud.h"

namespace planetree::tools {

/// Compares the pieces of a mesh with a model. The deviations are those of the triangles' corners.
/// Each counts by a third of the area of its triangles.
class MeshComparison {
 public:
  /// cloud  may be null; all others must outlive this
  MeshComparison(Probe& probe, const QueryOptions& options, double unit, DeviationTally& deviations,
                 HausdorffSearch& search, ColouredCloud* cloud)
      : probe_(probe),
        options_(options),
        unit_(unit),
        deviations_(deviations),
        search_(search),
        cloud_(cloud) {}

  /// Takes a piece.
  ///
  /// errors  those of temporary files
  Result<void> take(const MeshPiece& piece);

 private:
  void weigh(const MeshPiece& piece);
  Result<void> draw(const MeshPiece& piece, std::span<const double> deviations);

  Probe& probe_;
  const QueryOptions options_;
  const double unit_;  // a length in the order of the model's
  DeviationTally& deviations_;
  HausdorffSearch& search_;
  ColouredCloud* const cloud_;
  std::vector<ClosestPoint> answers_;
  std::vector<double> weights_, values_;
};

}  // namespace planetree::tools
