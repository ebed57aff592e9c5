#pragma once

#include <optional>
#include <span>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/session/ball_proxy.h"

namespace planetree::tools {

/// What a tool learns of the surface at one tick.
struct ToolAnswer {
  double width = 0;  ///< of the interval of the distance or, for a ball, BallProxy::Tick::lag
  Status status = Status::kExact;
  Side side = Side::kUnknown;  ///< of a point
  bool touches = false;        ///< of a ball: the surface stopped it
};

/// The tool of a haptic session: a point that asks for its nearest point, or a ball that the
/// surface stops.
class TouchTool {
 public:
  /// radius  of the ball, model units; 0: a point
  TouchTool(const Model& model, double radius);

  /// Makes the queries of a place once, before the first tick.
  void begin(Probe& probe, const Vec3& place, const QueryOptions& options);
  /// Moves the tool to a place.
  ToolAnswer move(Probe& probe, const Vec3& place, const QueryOptions& options) noexcept;

 private:
  std::optional<BallProxy> ball_;
};

}  // namespace planetree::tools
