#include "tools/trade/trade_points.h"

#include <cmath>
#include <random>

#include "tools/session/session_path.h"

namespace planetree::tools {
namespace {

/// Random points about a model.
class PointMaker {
 public:
  PointMaker(const ModelInfo& info, Probe& probe)
      : lower_(info.core_lower),
        size_{info.core_upper.x - lower_.x, info.core_upper.y - lower_.y,
              info.core_upper.z - lower_.z},
        reach_(0.001 * core_diagonal(info)),
        probe_(probe) {}

  Vec3 uniform() {
    const double x = between(-0.1, 1.1), y = between(-0.1, 1.1), z = between(-0.1, 1.1);
    return {lower_.x + size_.x * x, lower_.y + size_.y * y, lower_.z + size_.z * z};
  }
  Vec3 near() {
    const Vec3 on = probe_.closest_point(uniform(), {.parts = kDistance}).point;
    const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
    return {on.x + reach_ * x, on.y + reach_ * y, on.z + reach_ * z};
  }

 private:
  double between(double from, double to) {
    return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }

  const Vec3 lower_, size_;
  const double reach_;
  Probe& probe_;
  std::mt19937_64 random_{42};
};

}  // namespace

const char* name_of(TradeWorkload workload) {
  switch (workload) {
    case TradeWorkload::kUniform:
      return "uniform";
    case TradeWorkload::kNear:
      return "near";
    case TradeWorkload::kPath:
      return "path";
    case TradeWorkload::kGiven:
      return "points";
  }
  return "";
}

double core_diagonal(const ModelInfo& info) {
  return std::hypot(info.core_upper.x - info.core_lower.x, info.core_upper.y - info.core_lower.y,
                    info.core_upper.z - info.core_lower.z);
}

std::vector<Vec3> trade_points(const Model& model, Probe& probe, TradeWorkload workload,
                               std::size_t count) {
  if (workload == TradeWorkload::kPath)
    return touch_path(model, probe, TouchMotion::kScratch, count);
  PointMaker maker(model.info(), probe);
  std::vector<Vec3> points(count);
  for (Vec3& point : points)
    point = workload == TradeWorkload::kNear ? maker.near() : maker.uniform();
  return points;
}

}  // namespace planetree::tools
