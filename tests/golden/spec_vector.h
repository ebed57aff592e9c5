#pragma once

#include "tests/golden/spec_reader.h"

/// Part of the independent reader: see spec_reader.h.
namespace planetree::golden {

inline SpecPoint operator-(const SpecPoint& a, const SpecPoint& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline SpecPoint cross(const SpecPoint& a, const SpecPoint& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline double dot(const SpecPoint& a, const SpecPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace planetree::golden
