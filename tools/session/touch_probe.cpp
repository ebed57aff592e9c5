#include "tools/session/touch_probe.h"

namespace planetree::tools {
namespace {

/// Calls `of_model` or `of_scene` with the probe.
template <class OfModel, class OfScene>
auto with_probe(const std::variant<Probe*, SceneProbe*>& probe, OfModel of_model,
                OfScene of_scene) noexcept {
  if (Probe* const* const found = std::get_if<Probe*>(&probe)) return of_model(**found);
  return of_scene(**std::get_if<SceneProbe*>(&probe));
}

}  // namespace

SceneClosestPoint TouchProbe::closest_point(const Vec3& query,
                                            const QueryOptions& options) noexcept {
  return with_probe(
      probe_, [&](Probe& probe) { return SceneClosestPoint{probe.closest_point(query, options)}; },
      [&](SceneProbe& probe) { return probe.closest_point(query, options); });
}

SceneFirstContact TouchProbe::first_contact(const Sweep& sweep,
                                            const QueryOptions& options) noexcept {
  return with_probe(
      probe_, [&](Probe& probe) { return SceneFirstContact{probe.first_contact(sweep, options)}; },
      [&](SceneProbe& probe) { return probe.first_contact(sweep, 0, options); });
}

void TouchProbe::motion(const Vec3& position, const Vec3& velocity) noexcept {
  with_probe(
      probe_, [&](Probe& probe) { probe.motion(position, velocity); },
      [&](SceneProbe& probe) { probe.motion(position, velocity); });
}

}  // namespace planetree::tools
