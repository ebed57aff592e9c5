#pragma once

#include <cmath>
#include <string>
#include <string_view>

#include "planetree/contact.h"
#include "planetree/types.h"
#include "tools/answers/answer_writer.h"
#include "tools/answers/painted_point.h"
#include "tools/answers/placed_point.h"
#include "tools/answers/point_cloud.h"
#include "tools/answers/point_rows.h"
#include "tools/answers/way_rows.h"

/// The vertices that answers become in a PLY or a VTK file. Answers without a surface point have
/// none. A side alone has no surface point: the vertex is the query, which a PLY does not have.
namespace planetree::tools {

/// The name of the number that a viewer shows.
inline std::string shown_name(const AnswerForm& form, const ClosestPoint&) {
  return form.signed_distance ? "signed_distance" : "distance";
}
inline std::string shown_name(const AnswerForm&, const RayHit&) { return "t"; }
inline std::string shown_name(const AnswerForm&, const FirstContact&) { return "t"; }
inline std::string shown_name(const AnswerForm&, const Containment&) { return "side"; }

/// The field that has the vertex.
template <class Answer>
std::string_view vertex_name(const Answer&) {
  return kPointName.name;
}
inline std::string_view vertex_name(const Containment&) { return kQueryName.name; }

inline bool has_vertex(const ClosestPoint& answer) { return std::isfinite(answer.distance); }
inline bool has_vertex(const RayHit& hit) { return hit.triangle != kNoTriangle; }
inline bool has_vertex(const FirstContact& contact) { return contact.at.triangle != kNoTriangle; }
inline bool has_vertex(const Containment& answer) { return answer.status != Status::kBadQuery; }

inline bool has_normals(const AnswerForm& form, const ClosestPoint&) {
  return state_of(form, kNormal) == FieldState::kKnown;
}
inline bool has_normals(const AnswerForm& form, const PaintedPoint& answer) {
  return has_normals(form, static_cast<const ClosestPoint&>(answer));
}
inline bool has_normals(const AnswerForm& form, const PlacedPoint& answer) {
  return has_normals(form, static_cast<const ClosestPoint&>(answer));
}
template <class Answer>
bool has_normals(const AnswerForm&, const Answer&) {
  return true;
}

inline Result<void> add_vertex(PointCloud& cloud, const AnswerForm& form,
                               const ClosestPoint& answer) {
  return cloud.add(answer.point, answer.normal,
                   form.signed_distance ? signed_distance(answer) : answer.distance);
}
inline Result<void> add_vertex(PointCloud& cloud, const AnswerForm&, const RayHit& hit) {
  return cloud.add(hit.point, hit.normal, hit.t);
}
inline Result<void> add_vertex(PointCloud& cloud, const AnswerForm&, const FirstContact& contact) {
  return cloud.add(contact.at.point, contact.at.normal, contact.t);
}
inline Result<void> add_vertex(PointCloud&, const AnswerForm&, const Containment&) { return {}; }

}  // namespace planetree::tools
