#pragma once

#include <optional>

#include "planetree/types.h"
#include "tools/session/ball_proxy.h"
#include "tools/session/session_path.h"
#include "tools/session/touch_probe.h"

namespace planetree::tools {

/// What a tool learns of the surface at one tick.
struct ToolAnswer {
  double width = 0;  ///< of the interval of the distance or, for a ball, BallProxy::Tick::lag
  Status status = Status::kExact;
  Side side = Side::kUnknown;  ///< of a point
  bool touches = false;        ///< of a ball: the surface stopped it
  /// In a scene: the nearest one or, of a ball, the one that stopped it.
  InstanceId instance = kNoInstance;
};

/// The tool of a haptic session: a point that asks for its nearest point, or a ball that the
/// surface stops.
class TouchTool {
 public:
  /// box     of what the session touches
  /// radius  of the ball, model units; 0: a point
  /// moves   whether the surface moves during the session
  TouchTool(const PathBox& box, double radius, bool moves = false);

  /// Makes the queries of a place once, before the first tick.
  void begin(TouchProbe probe, const Vec3& place, const QueryOptions& options);
  /// Moves the tool to a place.
  ToolAnswer move(TouchProbe probe, const Vec3& place, const QueryOptions& options) noexcept;

 private:
  std::optional<BallProxy> ball_;
  bool moves_;
};

}  // namespace planetree::tools
