#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "planetree/contact.h"
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

inline std::array<std::uint64_t, 15> bits_of(const RayHit& hit) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return {bits(hit.t),
          bits(hit.t_lower),
          bits(hit.t_upper),
          bits(hit.point.x),
          bits(hit.point.y),
          bits(hit.point.z),
          bits(hit.normal.x),
          bits(hit.normal.y),
          bits(hit.normal.z),
          hit.triangle,
          bits(hit.barycentric.x),
          bits(hit.barycentric.y),
          bits(hit.barycentric.z),
          static_cast<std::uint64_t>(hit.entering),
          static_cast<std::uint64_t>(hit.status)};
}

/// All fields of a contact as bits.
struct ContactBits {
  std::array<std::uint64_t, 5> times;
  AnswerBits at;

  bool operator==(const ContactBits&) const = default;
};
inline ContactBits bits_of(const FirstContact& contact) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value); };
  return {{bits(contact.t), bits(contact.t_lower), bits(contact.t_upper),
           static_cast<std::uint64_t>(contact.free), static_cast<std::uint64_t>(contact.status)},
          bits_of(contact.at)};
}

}  // namespace planetree
