#include "tools/session/touch_tool.h"

#include <algorithm>

namespace planetree::tools {
namespace {

// The gap between ball and surface, as shares of the radius and of the model's longest edge. It
// must stay far above rounding.
constexpr double kGapOfRadius = 1e-4, kGapOfModel = 1e-8;

double longest_edge(const ModelInfo& info) {
  return std::max({info.core_upper.x - info.core_lower.x, info.core_upper.y - info.core_lower.y,
                   info.core_upper.z - info.core_lower.z});
}

}  // namespace

TouchTool::TouchTool(const Model& model, double radius) {
  if (radius > 0)
    ball_.emplace(radius,
                  std::max(kGapOfRadius * radius, kGapOfModel * longest_edge(model.info())));
}

void TouchTool::begin(Probe& probe, const Vec3& place, const QueryOptions& options) {
  if (ball_)
    ball_->put(probe, place);
  else
    (void)probe.closest_point(place, options);
}

ToolAnswer TouchTool::move(Probe& probe, const Vec3& place, const QueryOptions& options) noexcept {
  if (ball_) {
    const BallProxy::Tick tick = ball_->follow(probe, place, options);
    return {tick.lag, tick.status, Side::kUnknown, tick.touches};
  }
  const ClosestPoint answer = probe.closest_point(place, options);
  return {answer.upper - answer.lower, answer.status, answer.side, false};
}

}  // namespace planetree::tools
