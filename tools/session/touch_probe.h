#pragma once

#include <variant>

#include "planetree/probe.h"
#include "planetree/scene.h"

namespace planetree::tools {

/// The probe that a tool asks: that of a model or that of a scene. It refers to a probe that must
/// outlive it. Answers of a model have no instance.
class TouchProbe {
 public:
  // Implicit, so that what takes either probe can be called with one.
  TouchProbe(Probe& probe) : probe_(&probe) {}       // NOLINT(google-explicit-constructor)
  TouchProbe(SceneProbe& probe) : probe_(&probe) {}  // NOLINT(google-explicit-constructor)

  SceneClosestPoint closest_point(const Vec3& query, const QueryOptions& options = {}) noexcept;
  /// The first contact of a ball while instances stand still.
  SceneFirstContact first_contact(const Sweep& sweep, const QueryOptions& options) noexcept;
  void motion(const Vec3& position, const Vec3& velocity) noexcept;

 private:
  std::variant<Probe*, SceneProbe*> probe_;
};

}  // namespace planetree::tools
