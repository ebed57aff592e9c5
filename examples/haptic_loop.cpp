// The loop of a haptic device, without the device: 1000 ticks a second.
//
// haptic_loop MODEL.ptree
//   A tool is pushed into the top of a model and drawn along it. A ball, the proxy, follows it by
//   first contacts, so that it passes through no wall, however thin and however fast the tool is.
//   It stays outside and slides along the surface, and a spring pulls the tool to it: the
//   god-object method (Zilles and Salisbury, 1995).
// haptic_loop MODEL.ptree X,Y [two-sided] [below]
//   A hand presses the tip down over a place of the model until it rests, or up from below. A tip
//   that touches from two sides is a ball, and the normal points to it: so it rests on a thin sheet
//   from the front and from the back, also where the sheet has no front, as a Moebius strip.

#include <planetree/planetree.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <thread>

using planetree::Vec3;

namespace {

constexpr std::chrono::microseconds kPeriod(1000);
constexpr int kTicks = 1000;
constexpr double kTicksPerSecond = 1e6 / static_cast<double>(kPeriod.count());

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}

double length(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// A ball that follows the tool without entering the surface.
class Proxy {
 public:
  // centre  a place where the ball is free
  // gap     distance that it keeps from the surface: far above rounding, too small to feel
  Proxy(const Vec3& centre, double radius, double gap)
      : centre_(centre), radius_(radius), gap_(gap) {}

  // Moves towards the tool: straight on, then along a face, then along the edge between two faces.
  // Returns false if pages were missing. The ball has then moved as far as is certainly free.
  bool follow(planetree::Probe& probe, const Vec3& tool, const planetree::QueryOptions& options) {
    touches_ = false;
    Vec3 motion = sum(tool, centre_, -1), last_normal;
    for (int move = 0; move < 3 && length(motion) > gap_; ++move) {
      const planetree::FirstContact contact =
          probe.first_contact({centre_, sum(centre_, motion, 1), radius_}, options);
      const double free = std::min(1.0, contact.t_lower);
      const double share = contact.free ? 1 : std::max(0.0, free - gap_ / length(motion));
      centre_ = sum(centre_, motion, share);
      if (contact.free) return true;
      if (contact.status == planetree::Status::kDegraded) return false;
      touches_ = true;
      motion = sum({}, motion, 1 - share);
      const Vec3 normal = contact.at.normal;
      const Vec3 edge = cross(last_normal, normal);
      motion = dot(edge, edge) > 1e-12 ? sum({}, edge, dot(motion, edge) / dot(edge, edge))
                                       : sum(motion, normal, -std::min(0.0, dot(motion, normal)));
      last_normal = normal;
    }
    return true;
  }

  const Vec3& centre() const { return centre_; }
  bool touches() const { return touches_; }

 private:
  Vec3 centre_;
  const double radius_, gap_;
  bool touches_ = false;  // the surface stopped the last move
};

// Computes the force. Keeps the last contact for ticks at which the answer is not exact.
class Spring {
 public:
  // radius  of the tip, if it touches the surface from either side; 0: it is a point that touches
  //         the surface once it is inside.
  Spring(double stiffness, double radius) : stiffness_(stiffness), radius_(radius) {}

  Vec3 force(const Vec3& tip, const planetree::ClosestPoint& answer) {
    if (answer.status == planetree::Status::kExact) {
      touching_ = radius_ > 0 ? answer.distance < radius_ : answer.signed_distance() < 0;
      contact_ = answer.point;
      normal_ = answer.normal;
    } else if (answer.lower > radius_ &&
               (radius_ > 0 || answer.side == planetree::Side::kOutside)) {
      // The interval may be wide, but it proves that the tip is clear of the surface.
      touching_ = false;
    }
    // Otherwise pages are missing: the plane of the last contact stands for the surface.
    if (!touching_) return {};
    const Vec3 way = sum(contact_, tip, -1);
    const double depth = way.x * normal_.x + way.y * normal_.y + way.z * normal_.z + radius_;
    return depth > 0 ? sum({}, normal_, stiffness_ * depth) : Vec3{};
  }

 private:
  const double stiffness_;  // force per model unit
  const double radius_;
  bool touching_ = false;
  Vec3 contact_, normal_;
};

struct Session {
  const planetree::ModelInfo& info;
  planetree::Probe& probe;
  double diagonal;
  int touching = 0, uncertain = 0;
  double strongest = 0;

  // One tick: the force on a tip that moves by `move` a tick.
  Vec3 force(Spring& spring, const Vec3& tip, const Vec3& move,
             const planetree::QueryOptions& options) {
    probe.motion(tip, sum({}, move, kTicksPerSecond));
    const planetree::ClosestPoint answer = probe.closest_point(tip, options);
    const Vec3 force = spring.force(tip, answer);
    strongest = std::max(strongest, length(force));
    touching += length(force) > 0;
    uncertain += answer.status != planetree::Status::kExact;
    return force;
  }
  void report() const {
    std::printf("%d ticks: %d with contact, %d uncertain; strongest force %.3g\n", kTicks, touching,
                uncertain, strongest);
  }
};

// The tool starts above the middle of the model's top, moves down into the model, then sideways.
int stroke(Session& session) {
  const Vec3 size = sum(session.info.core_upper, session.info.core_lower, -1);
  const double step = 1e-4 * session.diagonal, radius = 10 * step, stiffness = 1 / step;
  Vec3 tool = sum(session.info.core_lower, size, 0.5);
  tool.z = session.info.core_upper.z + 0.01 * session.diagonal;
  Proxy proxy(tool, radius, 1e-3 * radius);
  planetree::QueryOptions options;
  options.wait = planetree::Wait::kNever;
  auto due = std::chrono::steady_clock::now();
  for (int tick = 0; tick < kTicks; ++tick) {
    std::this_thread::sleep_until(due += kPeriod);
    const bool sinking = session.touching < kTicks / 10;
    const Vec3 move = sinking ? Vec3{0, 0, -step} : Vec3{step, 0, 0};
    tool = sum(tool, move, 1);
    session.probe.motion(tool, sum({}, move, kTicksPerSecond));
    session.uncertain += !proxy.follow(session.probe, tool, options);
    const Vec3 force = sum({}, sum(proxy.centre(), tool, -1), stiffness);
    session.touching += proxy.touches();
    session.strongest = std::max(session.strongest, length(force));
  }
  session.report();
  // Not for real time: what the loop promises.
  const planetree::ClosestPoint end = session.probe.closest_point(proxy.centre());
  const bool is_outside = end.side == planetree::Side::kOutside && end.upper >= radius;
  std::printf("the ball of radius %.3g ends %.3g from the surface, %s\n", radius, end.distance,
              is_outside ? "outside" : "inside");
  return session.touching > 0 && is_outside ? 0 : 1;
}

// The hand moves the tip up or down with constant force against friction, and the spring stops it.
int press(Session& session, double x, double y, bool two_sided, bool from_below) {
  const double way = from_below ? 1 : -1;
  const double step = 1e-4 * session.diagonal, near = 200 * step;
  constexpr double kPush = 1;                   // force of the hand
  const double stiffness = kPush / (8 * step);  // a depth of 8 steps balances it
  const double radius = two_sided ? 100 * step : 0;

  // Before the first tick: goes near the surface in steps as long as the way that is free.
  const double beyond = 0.1 * session.diagonal;
  Vec3 tip{x, y,
           from_below ? session.info.core_lower.z - beyond : session.info.core_upper.z + beyond};
  planetree::QueryOptions options;
  options.parts = planetree::kDistance;
  for (int i = 0; i < 1000; ++i) {
    const double free = session.probe.closest_point(tip, options).lower - near;
    if (free < step) break;
    tip.z += way * free;
  }

  options = {};
  options.wait = planetree::Wait::kNever;
  options.normal_rule =
      two_sided ? planetree::NormalRule::kTowardQuery : planetree::NormalRule::kOutward;
  Spring spring(stiffness, radius);
  double speed = way * step;  // model units a tick
  int pulled_through = 0;
  auto due = std::chrono::steady_clock::now();
  for (int tick = 0; tick < kTicks; ++tick) {
    std::this_thread::sleep_until(due += kPeriod);
    const double force = session.force(spring, tip, {0, 0, speed}, options).z;
    pulled_through += way * force > 0;
    speed = step * (way * kPush + force) / kPush;
    tip.z += speed;
  }
  session.report();
  const bool rests = std::fabs(speed) < 0.01 * step && session.touching > 0;
  std::printf("%s at %.6g; %d ticks pulled the tip through\n", rests ? "at rest" : "moving", tip.z,
              pulled_through);
  return rests && pulled_through == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  double x = 0, y = 0;
  bool two_sided = false, from_below = false;
  const bool is_press = argc >= 3 && std::sscanf(argv[2], "%lf,%lf", &x, &y) == 2;
  bool is_valid = argc == 2 || is_press;
  for (int i = 3; i < argc; ++i) {
    const bool is_side = std::strcmp(argv[i], "two-sided") == 0;
    two_sided = two_sided || is_side;
    from_below = from_below || !is_side;
    is_valid = is_valid && (is_side || std::strcmp(argv[i], "below") == 0);
  }
  if (!is_valid) {
    std::fprintf(stderr, "usage: haptic_loop MODEL.ptree [X,Y [two-sided] [below]]\n");
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
  const planetree::ModelInfo& info = model->info();
  Session session{info, *probe, length(sum(info.core_upper, info.core_lower, -1))};
  return is_press ? press(session, x, y, two_sided, from_below) : stroke(session);
}
