#pragma once

#include <string_view>

#include "planetree/contact.h"
#include "tools/answers/answer_fields.h"
#include "tools/answers/answer_words.h"
#include "tools/answers/answer_writer.h"
#include "tools/answers/point_rows.h"

/// The fields of answers about rays and sweeps.
namespace planetree::tools {

inline constexpr VectorName kOriginName{"origin", {"x", "y", "z"}};
inline constexpr VectorName kDirectionName{"direction", {"dx", "dy", "dz"}};
inline constexpr VectorName kFromName{"from", {"x0", "y0", "z0"}};
inline constexpr VectorName kToName{"to", {"x1", "y1", "z1"}};

/// Fields about a triangle have no value where none was found.
inline FieldState state_of(std::uint64_t triangle) {
  return triangle != kNoTriangle ? FieldState::kKnown : FieldState::kNone;
}

template <class Fields>
void add_place(Fields& fields, const Vec3& point, const Vec3& normal, std::uint64_t triangle) {
  const FieldState found = state_of(triangle);
  add_vector(fields, kPointName, point, found);
  add_vector(fields, kNormalName, normal, found);
  fields.count("triangle", triangle, found);
}

template <class Fields>
void add_status(Fields& fields, Status status) {
  fields.code("status", named(status), static_cast<double>(status), FieldState::kKnown);
  fields.end();
}

template <class Fields>
void add_row(Fields& fields, const AnswerForm& form, const Ray& ray, const RayHit& hit) {
  add_vector(fields, kOriginName, ray.origin);
  add_vector(fields, kDirectionName, ray.direction);
  if (form.shows_range) {
    fields.number("t_min", ray.t_min);
    fields.number("t_max", ray.t_max);
  }
  fields.number("t", hit.t);
  fields.number("t_lower", hit.t_lower);
  fields.number("t_upper", hit.t_upper);
  add_place(fields, hit.point, hit.normal, hit.triangle);
  fields.flag("entering", hit.entering, state_of(hit.triangle));
  add_status(fields, hit.status);
}

template <class Fields>
void add_row(Fields& fields, const AnswerForm&, const Sweep& sweep, const FirstContact& contact) {
  add_vector(fields, kFromName, sweep.from);
  add_vector(fields, kToName, sweep.to);
  fields.number("radius", sweep.radius);
  fields.number("t", contact.t);
  fields.number("t_lower", contact.t_lower);
  fields.number("t_upper", contact.t_upper);
  const ClosestPoint& at = contact.at;
  add_place(fields, at.point, at.normal, at.triangle);
  fields.code("feature", named(at.feature), static_cast<double>(at.feature), state_of(at.triangle));
  add_status(fields, contact.status);
}

}  // namespace planetree::tools
