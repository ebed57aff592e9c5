#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "planetree/types.h"

namespace planetree {

/// All fields of an answer as bits: distance, lower, upper, point, normal, triangle, barycentric,
/// feature, side, status.
using AnswerBits = std::array<std::uint64_t, 16>;

inline AnswerBits bits_of(const ClosestPoint& answer) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return {bits(answer.distance),
          bits(answer.lower),
          bits(answer.upper),
          bits(answer.point.x),
          bits(answer.point.y),
          bits(answer.point.z),
          bits(answer.normal.x),
          bits(answer.normal.y),
          bits(answer.normal.z),
          answer.triangle,
          bits(answer.barycentric.x),
          bits(answer.barycentric.y),
          bits(answer.barycentric.z),
          static_cast<std::uint64_t>(answer.feature),
          static_cast<std::uint64_t>(answer.side),
          static_cast<std::uint64_t>(answer.status)};
}

}  // namespace planetree
