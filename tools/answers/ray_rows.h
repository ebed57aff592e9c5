#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planetree/probe.h"

namespace planetree::tools {

/// Finds the hits of rays: of each the first, or several in the order in which they are hit, a row
/// for each.
///
/// A ray has at least one row. One without a triangle says by its status that nothing is hit, or
/// that more hits may lack (kDegraded): then none that lacks comes before its t_lower.
class RayRows {
 public:
  /// probe  must outlive this
  /// most   hits of a ray, at least 1; 1: one row for each ray, by batches
  RayRows(Probe& probe, const QueryOptions& options, std::uint64_t most)
      : probe_(probe), options_(options), most_(most) {}

  /// Answers rays; replaces the rows.
  void answer(std::span<const Ray> rays);

  /// The ray of each row, and its hit. Valid until the next call, as the argument of the last.
  std::span<const Ray> rays() const { return ray_of_row_; }
  std::span<const RayHit> rows() const { return rows_; }

 private:
  void answer(const Ray& ray);
  void add(const Ray& ray, const RayHit& hit);

  Probe& probe_;
  const QueryOptions options_;
  const std::uint64_t most_;
  std::vector<RayHit> found_;  // of one ray
  std::vector<Ray> listed_;
  std::vector<RayHit> rows_;
  std::span<const Ray> ray_of_row_;
};

}  // namespace planetree::tools
