#pragma once

#include <limits>
#include <string_view>

#include "planetree/types.h"
#include "tools/answers/answer_fields.h"
#include "tools/answers/answer_words.h"
#include "tools/answers/answer_writer.h"

/// The fields of answers about points.
namespace planetree::tools {

inline constexpr VectorName kQueryName{"query", {"x", "y", "z"}};
inline constexpr VectorName kPointName{"point", {"px", "py", "pz"}};
inline constexpr VectorName kNormalName{"normal", {"nx", "ny", "nz"}};

/// A query that needs the normal computes all other parts, too.
inline FieldState state_of(const AnswerForm& form, std::uint32_t part) {
  return (form.parts & (part | kNormal)) != 0 ? FieldState::kKnown : FieldState::kNotRequested;
}

inline double signed_distance(const ClosestPoint& answer) {
  // Without the sign of a zero.
  if (answer.distance == 0 || answer.side == Side::kOnSurface) return answer.distance;
  if (answer.side == Side::kUnknown) return std::numeric_limits<double>::quiet_NaN();
  return answer.side == Side::kInside ? -answer.distance : answer.distance;
}

/// -1 inside, 0 on the surface, 1 outside.
inline double side_number(Side side) {
  return side == Side::kInside    ? -1
         : side == Side::kOutside ? 1
         : side == Side::kUnknown ? std::numeric_limits<double>::quiet_NaN()
                                  : 0;
}

template <class Fields>
void add_point(Fields& fields, const AnswerForm& form, const Vec3& query,
               const ClosestPoint& answer) {
  const FieldState distance = state_of(form, kDistance);
  const bool has_triangle = answer.triangle != kNoTriangle;
  add_vector(fields, kQueryName, query);
  if (form.signed_distance)
    fields.number("signed_distance", signed_distance(answer), distance);
  else
    fields.number("distance", answer.distance, distance);
  fields.number("lower", answer.lower, distance);
  fields.number("upper", answer.upper, distance);
  fields.code("side", named(answer.side), side_number(answer.side), state_of(form, kSide));
  add_vector(fields, kPointName, answer.point, distance);
  add_vector(fields, kNormalName, answer.normal, state_of(form, kNormal));
  fields.count("triangle", answer.triangle,
               has_triangle || distance != FieldState::kKnown ? distance : FieldState::kNone);
  fields.word("feature", named(answer.feature), distance);
  fields.word("status", named(answer.status));
}

template <class Fields>
void add_row(Fields& fields, const AnswerForm& form, const Vec3& query,
             const ClosestPoint& answer) {
  add_point(fields, form, query, answer);
  fields.end();
}

template <class Fields>
void add_row(Fields& fields, const AnswerForm&, const Vec3& query, const Containment& answer) {
  add_vector(fields, kQueryName, query);
  fields.code("side", named(answer.side), side_number(answer.side), FieldState::kKnown);
  fields.word("status", named(answer.status));
  fields.end();
}

}  // namespace planetree::tools
