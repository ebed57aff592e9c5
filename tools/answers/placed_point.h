#pragma once

#include <cstdint>
#include <limits>

#include "planetree/types.h"
#include "tools/answers/point_rows.h"

/// Answers of scenes.
namespace planetree::tools {

/// A nearest point, and the instance that it is on.
struct PlacedPoint : ClosestPoint {
  static constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

  std::uint64_t instance = kNone;  ///< its position in the scene file
};

template <class Fields>
void add_row(Fields& fields, const AnswerForm& form, const Vec3& query, const PlacedPoint& answer) {
  add_point(fields, form, query, answer);
  fields.count("instance", answer.instance,
               answer.instance == PlacedPoint::kNone ? FieldState::kNone : FieldState::kKnown);
  fields.end();
}

}  // namespace planetree::tools
