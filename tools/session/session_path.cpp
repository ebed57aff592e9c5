#include "tools/session/session_path.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace planetree::tools {
namespace {

constexpr std::size_t kTicksAtOnePoint = 100;
constexpr double kTurn = 0.05;           // maximum change of direction a tick, about in radians
constexpr double kHeight = 1e-3;         // height of the tip, as a share of the diagonal
constexpr std::size_t kBobTicks = 1300;  // period of the height

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

class Walk {
 public:
  Walk(TouchProbe probe, const PathBox& box, double step, std::uint64_t seed)
      : box_(box),
        diagonal_(length(sum(box.upper, box.lower, -1))),
        step_(step * diagonal_),
        probe_(probe),
        random_(seed) {}

  // Moves to a random surface point.
  void jump() {
    at_ = probe_.closest_point(random_point()).point;
    heading_ = random_direction();
  }

  // Moves along the surface by one step.
  void go(std::size_t tick) {
    const double phase = static_cast<double>(tick % kBobTicks) / kBobTicks;
    const double height = kHeight * diagonal_ * (2.2 * std::fabs(phase - 0.5) - 0.1);
    const ClosestPoint ahead = probe_.closest_point(sum(at_, heading_, step_));
    const Vec3 wanted = sum(ahead.point, ahead.normal, height);
    Vec3 way = sum(wanted, at_, -1);
    const double far = length(way);
    // Limits the step, because the surface may be steep there.
    if (far > step_) way = {way.x * step_ / far, way.y * step_ / far, way.z * step_ / far};
    at_ = sum(at_, way, 1);
    turn(ahead.normal, far < step_ / 4);
  }

  const Vec3& at() const { return at_; }

 private:
  // Keeps the heading along the surface, or chooses another one if the tip is stuck.
  void turn(const Vec3& normal, bool stuck) {
    const Vec3 other = random_direction();
    Vec3 heading = stuck ? other : sum(heading_, other, kTurn);
    heading = sum(heading, normal, -dot(heading, normal));
    const double size = length(heading);
    heading_ = size > 1e-6 ? Vec3{heading.x / size, heading.y / size, heading.z / size} : other;
  }

  double random_between(double from, double to) {
    return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  Vec3 random_point() {
    const double x = random_between(box_.lower.x, box_.upper.x);
    const double y = random_between(box_.lower.y, box_.upper.y);
    return {x, y, random_between(box_.lower.z, box_.upper.z)};
  }
  Vec3 random_direction() {
    for (;;) {
      const double x = random_between(-1, 1);
      const double y = random_between(-1, 1);
      const Vec3 way{x, y, random_between(-1, 1)};
      const double size = length(way);
      if (size > 0.1 && size < 1) return {way.x / size, way.y / size, way.z / size};
    }
  }

  const PathBox box_;
  const double diagonal_;
  const double step_;
  TouchProbe probe_;
  std::mt19937_64 random_;
  Vec3 at_;
  Vec3 heading_;
};

}  // namespace

std::vector<Vec3> touch_path(const Model& model, Probe& probe, TouchMotion motion,
                             std::size_t ticks, std::uint64_t seed) {
  return touch_path(probe, PathBox::of(model.info()), motion, ticks, seed);
}

std::vector<Vec3> touch_path(TouchProbe probe, const PathBox& box, TouchMotion motion,
                             std::size_t ticks, std::uint64_t seed, const TickAction& begin_tick) {
  Walk walk(probe, box, motion == TouchMotion::kScratch ? 1e-3 : 2e-4, seed);
  walk.jump();
  std::vector<Vec3> path;
  path.reserve(ticks);
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    if (begin_tick) begin_tick(tick);
    if (motion != TouchMotion::kTeleport)
      walk.go(tick);
    else if (tick % kTicksAtOnePoint == 0)
      walk.jump();
    path.push_back(walk.at());
  }
  return path;
}

}  // namespace planetree::tools
