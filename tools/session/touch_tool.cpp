#include "tools/session/touch_tool.h"

#include <algorithm>

namespace planetree::tools {
namespace {

// The gap between ball and surface, as shares of the radius and of the box's longest edge. It
// must stay far above rounding.
constexpr double kGapOfRadius = 1e-4, kGapOfBox = 1e-8;

double longest_edge(const PathBox& box) {
  return std::max(
      {box.upper.x - box.lower.x, box.upper.y - box.lower.y, box.upper.z - box.lower.z});
}

}  // namespace

TouchTool::TouchTool(const PathBox& box, double radius, bool moves) : moves_(moves) {
  if (radius > 0)
    ball_.emplace(radius, std::max(kGapOfRadius * radius, kGapOfBox * longest_edge(box)));
}

void TouchTool::begin(TouchProbe probe, const Vec3& place, const QueryOptions& options) {
  if (ball_)
    ball_->put(probe, place);
  else
    (void)probe.closest_point(place, options);
}

ToolAnswer TouchTool::move(TouchProbe probe, const Vec3& place,
                           const QueryOptions& options) noexcept {
  if (ball_) {
    const BallProxy::Tick tick = moves_ ? ball_->follow_among_moving(probe, place, options)
                                        : ball_->follow(probe, place, options);
    return {tick.lag, tick.status, Side::kUnknown, tick.touches, tick.instance};
  }
  const SceneClosestPoint answer = probe.closest_point(place, options);
  return {answer.upper - answer.lower, answer.status, answer.side, false, answer.instance};
}

}  // namespace planetree::tools
