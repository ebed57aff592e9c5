#pragma once

#include <vector>

#include "tests/oracle/random.h"
#include "tests/soak/fielded_models.h"

/// Queries at the critical places of a coarse field.
namespace planetree::oracle {

/// Draws queries for a model: in and about its box, near and on the surface, at the points of its
/// field's grid and an ulp beside them, at the faces of the grid, outside of it, at strays, and up
/// to 1e15 sizes away.
class FieldPlaces {
 public:
  /// Both must outlive this.
  FieldPlaces(const FieldedModel& model, const BuiltModel& built);

  Vec3 any(Random& random);
  /// A point a short step beside the last one.
  Vec3 next(Random& random);

 private:
  [[nodiscard]] Vec3 place(Random& random) const;
  [[nodiscard]] Vec3 grid_point(Random& random, bool at_face) const;
  [[nodiscard]] Vec3 in_box(Random& random, double reach) const;

  const FieldedModel& model_;
  const BuiltModel& built_;
  Vec3 last_;
};

}  // namespace planetree::oracle
