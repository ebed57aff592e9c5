#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tests/golden/spec_reader.h"

namespace planetree::golden {

/// The bounds of "Bounds of the field".
struct SpecBounds {
  double lower, upper;
};

/// The coarse field of a file. Part of the independent reader: see spec_reader.h.
class SpecField {
 public:
  explicit SpecField(const SpecFile& file);

  std::uint64_t size() const { return stored_.size(); }
  /// A grid point, and the point stored for it; model frame.
  SpecPoint grid_point(std::uint64_t number) const;
  SpecPoint stored_point(std::uint64_t number) const;
  /// Bounds on the distance of a point of the model frame to the surface, which lies in the grid.
  SpecBounds bounds(const SpecPoint& point) const;

 private:
  std::uint64_t number_of(const std::array<std::uint32_t, 3>& at) const;
  void read_page(const SpecFile& file, std::uint32_t number);

  SpecHeader header_;
  std::vector<std::array<std::uint16_t, 3>> stored_;
};

}  // namespace planetree::golden
