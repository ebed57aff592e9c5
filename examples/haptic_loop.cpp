// The loop of a haptic device, without the device. A tool tip is pushed into a surface and drawn
// along it, in 1000 ticks a second. While the tip is below the surface, a proxy stays on the
// surface and a spring pulls the tip to it: the god-object method (Zilles and Salisbury, 1995).
// usage: haptic_loop MODEL.ptree

#include <planetree/planetree.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

using planetree::Vec3;

namespace {

constexpr std::chrono::microseconds kPeriod(1000);
constexpr int kTicks = 1000;

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}

double length(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

// Computes the force. Keeps the last contact for ticks at which the answer is not exact.
class Spring {
 public:
  explicit Spring(double stiffness) : stiffness_(stiffness) {}

  Vec3 force(const Vec3& tip, const planetree::ClosestPoint& answer) {
    if (answer.status == planetree::Status::kExact) {
      touching_ = answer.side == planetree::Side::kInside;
      contact_ = answer.point;
      normal_ = answer.normal;
    } else if (answer.lower > 0 && answer.side == planetree::Side::kOutside) {
      // The interval may be wide, but it proves that the tip is clear of the surface.
      touching_ = false;
    }
    // Otherwise pages are missing: the plane of the last contact stands for the surface.
    if (!touching_) return {};
    const Vec3 way = sum(contact_, tip, -1);
    const double depth = way.x * normal_.x + way.y * normal_.y + way.z * normal_.z;
    return depth > 0 ? sum({}, normal_, stiffness_ * depth) : Vec3{};
  }

 private:
  const double stiffness_;  // force per model unit
  bool touching_ = false;
  Vec3 contact_, normal_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: haptic_loop MODEL.ptree\n");
    return 2;
  }
  planetree::OpenOptions options;
  options.memory_budget_bytes = std::uint64_t{16} << 20;
  const auto model = planetree::Model::open(argv[1], options);
  if (!model) {
    std::fprintf(stderr, "haptic_loop: %s: %s\n", argv[1], model.error().text);
    return 1;
  }
  auto probe = planetree::Probe::create(*model);
  if (!probe) {
    std::fprintf(stderr, "haptic_loop: %s\n", probe.error().text);
    return 1;
  }

  // The tip starts above the middle of the model's top, moves down into the model, then sideways.
  const planetree::ModelInfo& info = model->info();
  const Vec3 size = sum(info.core_upper, info.core_lower, -1);
  const double diagonal = length(size);
  Vec3 tip = sum(info.core_lower, size, 0.5);
  tip.z = info.core_upper.z + 0.01 * diagonal;
  const double per_second = 1e6 / static_cast<double>(kPeriod.count());
  const double step = 1e-4 * diagonal;

  Spring spring(1 / step);
  planetree::QueryOptions query_options;
  query_options.wait = planetree::Wait::kNever;
  double strongest = 0;
  int touching = 0, uncertain = 0;
  auto due = std::chrono::steady_clock::now();
  for (int tick = 0; tick < kTicks; ++tick) {
    std::this_thread::sleep_until(due += kPeriod);
    const bool sinking = touching < kTicks / 10;
    const Vec3 move = sinking ? Vec3{0, 0, -step} : Vec3{step, 0, 0};
    tip = sum(tip, move, 1);
    probe->motion(tip, sum({}, move, per_second));
    const planetree::ClosestPoint answer = probe->closest_point(tip, query_options);
    const double force = length(spring.force(tip, answer));
    strongest = std::max(strongest, force);
    touching += force > 0;
    uncertain += answer.status != planetree::Status::kExact;
  }
  std::printf("%d ticks: %d with contact, %d uncertain; strongest force %.3g\n", kTicks, touching,
              uncertain, strongest);
  return touching > 0 ? 0 : 1;
}
