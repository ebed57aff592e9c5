#pragma once

#include <cmath>

#include "planetree/contact.h"
#include "planetree/types.h"
#include "tools/answers/answer_writer.h"
#include "tools/answers/point_cloud.h"
#include "tools/answers/point_rows.h"

/// The vertices that answers become in a PLY: the surface point, its normal, and the distance or
/// the position. Answers without a surface point have none.
namespace planetree::tools {

inline Result<PointCloud> make_cloud(const AnswerForm& form, const ClosestPoint&) {
  return PointCloud::create(form.signed_distance ? "signed_distance" : "distance",
                            state_of(form, kNormal) == FieldState::kKnown);
}
inline Result<PointCloud> make_cloud(const AnswerForm&, const RayHit&) {
  return PointCloud::create("t", true);
}
inline Result<PointCloud> make_cloud(const AnswerForm&, const FirstContact&) {
  return PointCloud::create("t", true);
}
inline Result<PointCloud> make_cloud(const AnswerForm&, const Containment&) {
  return PointCloud::create("side", false);
}

inline Result<void> add_vertex(PointCloud& cloud, const AnswerForm& form,
                               const ClosestPoint& answer) {
  if (!std::isfinite(answer.distance)) return {};
  return cloud.add(answer.point, answer.normal,
                   form.signed_distance ? signed_distance(answer) : answer.distance);
}
inline Result<void> add_vertex(PointCloud& cloud, const AnswerForm&, const RayHit& hit) {
  if (hit.triangle == kNoTriangle) return {};
  return cloud.add(hit.point, hit.normal, hit.t);
}
inline Result<void> add_vertex(PointCloud& cloud, const AnswerForm&, const FirstContact& contact) {
  if (contact.at.triangle == kNoTriangle) return {};
  return cloud.add(contact.at.point, contact.at.normal, contact.t);
}
inline Result<void> add_vertex(PointCloud&, const AnswerForm&, const Containment&) { return {}; }

}  // namespace planetree::tools
