#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "tests/golden/spec_mask.h"
#include "tests/golden/spec_tree.h"

/// Part of the independent reader: see spec_reader.h.
namespace planetree::golden {

enum class SpecSide { kInside, kOutside, kOnSurface, kUnknown };

/// A value and the greatest distance of the true value from it.
struct SpecShare {
  double value, error;
};

/// far() of "Share of the caps".
SpecShare far(const SpecTree& caps, const SpecChild& child, const SpecPoint& p);

/// "Side of a point". Coordinates are below 8 by magnitude, see spec_signs.h.
class SpecSides {
 public:
  explicit SpecSides(const SpecFile& file);

  SpecSide side(const SpecPoint& p) const;

 private:
  /// The winding number of the closed surface.
  struct Closed {
    std::int64_t number = 0;
    bool is_sign = false;  ///< only the sign is known
    bool is_on_surface = false;
  };
  /// A point where the winding number is known.
  struct KnownPoint {
    SpecPoint point;
    std::int64_t number;
  };
  /// Triangles, the caps last.
  struct Triangles {
    std::vector<SpecTriangle> all;
    std::size_t surface_count = 0;
  };

  Closed closed(const SpecPoint& p) const;
  Closed closed_in_leaf(const SpecPoint& p, const SpecCell& cell,
                        const SpecMaskRecord& record) const;
  Closed count(const SpecPoint& p, const KnownPoint& known, const Triangles& triangles) const;
  KnownPoint known_point() const;
  KnownPoint nearest_corner(const SpecPoint& p, const SpecCell& cell,
                            const SpecMaskRecord& record) const;
  unsigned octant_of(const SpecPoint& p, const SpecCell& cell) const;
  bool is_in(const SpecPoint& p, const SpecPoint& lower, const SpecPoint& upper) const;
  Triangles of_blocks(std::span<const SpecListedBlock> blocks, unsigned octant) const;
  SpecShare share(const SpecPoint& p, double k) const;
  double star(const SpecPoint& p) const;

  SpecHeader header_;
  SpecTree tree_;
  std::vector<SpecTree> caps_;  // one, or none
  SpecMask mask_;
  Triangles all_;
};

}  // namespace planetree::golden
