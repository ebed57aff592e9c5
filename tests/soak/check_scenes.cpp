// Compares a scene of many instances with each of its models by itself.
// usage: check_scenes INSTANCES MEMORY_MB QUERIES SECONDS MODEL.ptree...
//
// The instances stand around a common point, so that several are near any of them, and a tenth of
// them moves before each query. Nearest points, sides, contacts and first contacts of moving balls
// must agree with exact answers of the models at positions that are moved in long double; so must
// answers that did not wait for pages. Then a real-time thread moves all instances and asks at
// 1 kHz. Exit status 1 if any answer is wrong.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "planetree/planetree.h"
#include "tools/session/real_time.h"

namespace planetree {
namespace {

using Real = long double;
using Clock = std::chrono::steady_clock;

struct Reference {
  explicit Reference(const std::string& path)
      : model(*Model::open(
            path, {.memory_budget_bytes = std::uint64_t{16} << 30, .locking = Locking::kNever})),
        probe(*Probe::create(model)) {}

  Model model;
  Probe probe;
};

struct Placed {
  Reference* reference;
  Pose pose;
  InstanceId id;
};

// A point in the frame of an instance, and how far it is off.
struct Local {
  Vec3 at;
  Real slack;
};

Local to_local(const Pose& pose, const Vec3& world) {
  const Real w = pose.rotation.w, x = -Real(pose.rotation.x), y = -Real(pose.rotation.y),
             z = -Real(pose.rotation.z);
  const Real n = w * w + x * x + y * y + z * z;
  const Real d[3] = {Real(world.x) - pose.translation.x, Real(world.y) - pose.translation.y,
                     Real(world.z) - pose.translation.z};
  const auto cross = [&](const Real(&v)[3], Real(&out)[3]) {
    out[0] = y * v[2] - z * v[1];
    out[1] = z * v[0] - x * v[2];
    out[2] = x * v[1] - y * v[0];
  };
  Real once[3], twice[3], sum[3];
  cross(d, once);
  cross(once, twice);
  for (int i = 0; i < 3; ++i) sum[i] = d[i] + 2 * (w * once[i] + twice[i]) / n;
  const Vec3 at{double(sum[0]), double(sum[1]), double(sum[2])};
  const Real size = std::fabs(sum[0]) + std::fabs(sum[1]) + std::fabs(sum[2]);
  const Real off = std::fabs(sum[0] - at.x) + std::fabs(sum[1] - at.y) + std::fabs(sum[2] - at.z);
  return {at, off + 0x1p-58L * size};
}

// The distance of all instances from a point, as an interval.
struct Truth {
  Real lower = std::numeric_limits<Real>::infinity(), upper = lower;
  bool is_inside = false, is_outside = true;  // both false: not certain
};

Truth truth_of(std::vector<Placed>& placed, const Vec3& query) {
  Truth truth;
  for (Placed& each : placed) {
    const Local local = to_local(each.pose, query);
    QueryOptions options;
    if (std::isfinite(truth.upper)) options.max_distance = double(truth.upper) * 1.001;
    const ClosestPoint nearest = each.reference->probe.closest_point(local.at, options);
    const Containment side = each.reference->probe.contains(local.at);
    const bool is_beyond = nearest.status == Status::kBeyondMaxDistance;
    if (!is_beyond) {
      truth.lower = std::min(truth.lower, nearest.lower - local.slack);
      truth.upper = std::min(truth.upper, nearest.upper + local.slack);
    }
    const bool is_certain = nearest.lower > local.slack && side.status == Status::kExact;
    truth.is_inside |= is_certain && side.side == Side::kInside;
    truth.is_outside &= is_certain && side.side == Side::kOutside;
  }
  return truth;
}

bool holds(const Truth& truth, const ClosestPoint& answer) {
  return answer.lower <= truth.upper && answer.upper >= truth.lower;
}

struct Tally {
  std::size_t nearest = 0, sides = 0, contacts = 0, sweeps = 0, at_once = 0, degraded = 0,
              not_exact = 0, wrong = 0;
};

class SceneCheck {
 public:
  SceneCheck(Scene& scene, std::vector<Placed>& placed, double size)
      : scene_(scene), placed_(placed), size_(size), probe_(*SceneProbe::create(scene)) {}

  void check_queries(std::size_t queries) {
    for (std::size_t i = 0; i < queries; ++i) {
      move_some();
      const Vec3 query = near_surface();
      const Truth truth = truth_of(placed_, query);
      check_nearest(truth, query);
      if (i % 4 == 0) check_contacts(truth, query);
      if (i % 4 == 1) check_sweep(query);
    }
  }

  const Tally& tally() const { return tally_; }

 private:
  double uniform(double from, double to) {
    return from + (to - from) * static_cast<double>(random_() >> 11) * 0x1p-53;
  }
  void count_wrong(const char* what, const Vec3& query) {
    std::printf("wrong %s at %.17g %.17g %.17g\n", what, query.x, query.y, query.z);
    ++tally_.wrong;
  }
  void move_some() {
    for (std::size_t i = 0; i < placed_.size() / 10; ++i) {
      Placed& each = placed_[random_() % placed_.size()];
      Quaternion& q = each.pose.rotation;
      q = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)};
      const double length = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
      q = {q.w / length, q.x / length, q.y / length, q.z / length};
      for (double* axis :
           {&each.pose.translation.x, &each.pose.translation.y, &each.pose.translation.z})
        *axis = uniform(-2, 2) * size_;
      if (!scene_.set_pose(each.id, each.pose)) std::abort();
    }
  }
  // A point near the surface of some instance, more often than not.
  Vec3 near_surface() {
    Vec3 at{uniform(-2, 2) * size_, uniform(-2, 2) * size_, uniform(-2, 2) * size_};
    if (random_() % 4 == 0) return at;
    const SceneClosestPoint nearest = probe_.closest_point(at, {.parts = kDistance});
    const double off = std::pow(10, uniform(-12, -1)) * size_;
    return {nearest.point.x + off, nearest.point.y - off, nearest.point.z + off / 2};
  }
  void check_nearest(const Truth& truth, const Vec3& query) {
    const SceneClosestPoint now = probe_.closest_point(query, {.wait = Wait::kNever});
    ++tally_.at_once;
    tally_.degraded += now.status == Status::kDegraded;
    if (!holds(truth, now)) count_wrong("answer that did not wait", query);
    const SceneClosestPoint answer = probe_.closest_point(query, {.parts = kDistance});
    ++tally_.nearest;
    tally_.not_exact += answer.status != Status::kExact;
    if (!holds(truth, answer)) count_wrong("nearest point", query);
    if (Real(answer.upper) - answer.lower > 1e-9L * size_) count_wrong("width", query);
    const SceneContainment side = probe_.contains(query);
    ++tally_.sides;
    const bool is_wrong = (side.side == Side::kInside && truth.is_outside) ||
                          (side.side == Side::kOutside && truth.is_inside);
    if (is_wrong) count_wrong("side", query);
  }
  void check_contacts(const Truth& truth, const Vec3& query) {
    const double radius = double(truth.upper) * uniform(1, 3);
    const Found set = probe_.contacts(query, radius, found_, {.parts = kDistance});
    ++tally_.contacts;
    if (set.count == 0 || !holds(truth, found_[0])) count_wrong("first contact", query);
    for (std::size_t i = 0; i < set.count; ++i) {
      const SceneClosestPoint& contact = found_[i];
      const auto placed = std::ranges::find(placed_, contact.instance, &Placed::id);
      const Local local = to_local(placed->pose, query);
      const ClosestPoint nearest = placed->reference->probe.closest_point(local.at);
      if (contact.upper < nearest.lower - local.slack || contact.lower > radius * 1.000001)
        count_wrong("contact", query);
    }
  }
  void check_sweep(const Vec3& from) {
    const Vec3 to{from.x + uniform(-1, 1) * size_, from.y + uniform(-1, 1) * size_,
                  from.z + uniform(-1, 1) * size_};
    const double radius = uniform(0, 0.05) * size_;
    const SceneFirstContact contact = probe_.first_contact({from, to, radius});
    ++tally_.sweeps;
    const auto distance_at = [&](double t) {
      return truth_of(placed_, {from.x + (to.x - from.x) * t, from.y + (to.y - from.y) * t,
                                from.z + (to.z - from.z) * t});
    };
    const Real slack = 1e-14L * size_;
    for (int step = 0; step < 4 && contact.t_lower > 0; ++step) {
      const double t = std::min(1.0, contact.t_lower) * step / 4;
      if (distance_at(t).upper + slack < radius) count_wrong("free way", from);
    }
    if (contact.t_upper <= 1 && distance_at(contact.t_upper).lower - slack > radius)
      count_wrong("touch", from);
  }

  Scene& scene_;
  std::vector<Placed>& placed_;
  const double size_;
  SceneProbe probe_;
  std::mt19937_64 random_{1};
  std::vector<SceneClosestPoint> found_ = std::vector<SceneClosestPoint>(64);
  Tally tally_;
};

// Moves all instances and asks, each millisecond. Prints how many ticks were late, and how many of
// an idle thread on the same processor.
void run_real_time(Scene& scene, std::vector<Placed>& placed, double size, int seconds) {
  const auto period = std::chrono::milliseconds(1);
  const int ticks = seconds * 1000;
  const auto start = Clock::now() + std::chrono::milliseconds(10);
  int late = 0, idle_late = 0, degraded = 0;
  std::thread idle([&] {
    tools::become_real_time();
    for (int i = 0; i < ticks; ++i) {
      const auto due = start + period * i + period / 2;
      std::this_thread::sleep_until(due);
      idle_late += Clock::now() - due > period;
    }
  });
  std::thread tool([&] {
    auto probe = SceneProbe::create(scene);
    tools::become_real_time();
    for (int i = 0; i < ticks; ++i) {
      const auto due = start + period * i;
      std::this_thread::sleep_until(due);
      for (Placed& each : placed) {
        Pose pose = each.pose;
        pose.translation.x += 0.0001 * size * (i % 1000);
        if (!scene.set_pose(each.id, pose, {{0.1 * size, 0, 0}, {}})) std::abort();
      }
      const Vec3 tip{size * 0.001 * (i % 2000 - 1000), size * 0.3, size * 0.2};
      const SceneClosestPoint answer = probe->closest_point(tip, {.wait = Wait::kNever});
      degraded += answer.status == Status::kDegraded;
      probe->contains(tip, {.wait = Wait::kNever});
      probe->first_contact({tip, {tip.x + 0.01 * size, tip.y, tip.z}, 0.01 * size}, 0.001,
                           {.wait = Wait::kNever});
      probe->motion(tip, {size, 0, 0});
      late += Clock::now() - due > period;
    }
  });
  tool.join();
  idle.join();
  std::printf(
      "%d ticks at 1 kHz, each with %zu poses: %d late, %d of an idle thread; %d degraded\n", ticks,
      placed.size(), late, idle_late, degraded);
}

int run(std::size_t instances, std::uint64_t memory_mb, std::size_t queries, int seconds,
        const std::vector<std::string>& files) {
  auto scene = Scene::create({.memory_budget_bytes = memory_mb << 20, .max_probes = 2});
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().text);
    return 1;
  }
  std::vector<std::unique_ptr<Reference>> references;
  for (const std::string& file : files) references.push_back(std::make_unique<Reference>(file));
  std::vector<Placed> placed;
  double size = 0;
  for (std::size_t i = 0; i < instances; ++i) {
    const auto id = scene->add(files[i % files.size()]);
    if (!id) {
      std::fprintf(stderr, "%s: %s\n", files[i % files.size()].c_str(), id.error().text);
      return 1;
    }
    Reference& reference = *references[i % files.size()];
    placed.push_back({&reference, {}, *id});
    const ModelInfo& info = reference.model.info();
    size = std::max({size, info.box_upper.x - info.box_lower.x, info.box_upper.y - info.box_lower.y,
                     info.box_upper.z - info.box_lower.z});
  }
  for (std::size_t i = 0; i < files.size() && i < placed.size(); ++i)
    std::printf("%s: %llu triangles, %.3f MB besides pages\n", files[i].c_str(),
                static_cast<unsigned long long>((*scene->info(placed[i].id))->triangles),
                static_cast<double>(scene->memory(placed[i].id)->total) / 1e6);
  SceneCheck check(*scene, placed, size);
  check.check_queries(queries);
  const Tally& tally = check.tally();
  const SceneStats stats = scene->stats();
  std::printf(
      "%u instances of %u models in %llu MB (%llu frames): %zu nearest points (%zu not "
      "exact), %zu sides, %zu sets of contacts, %zu sweeps, %zu at once (%zu degraded), "
      "%zu wrong\n",
      stats.instances, stats.models, static_cast<unsigned long long>(memory_mb),
      static_cast<unsigned long long>(stats.frames), tally.nearest, tally.not_exact, tally.sides,
      tally.contacts, tally.sweeps, tally.at_once, tally.degraded, tally.wrong);
  if (seconds > 0) run_real_time(*scene, placed, size, seconds);
  return tally.wrong == 0 ? 0 : 1;
}

}  // namespace
}  // namespace planetree

int main(int count, char** arguments) {
  if (count < 6) {
    std::fprintf(stderr,
                 "usage: check_scenes INSTANCES MEMORY_MB QUERIES SECONDS MODEL.ptree...\n");
    return 2;
  }
  return planetree::run(std::strtoull(arguments[1], nullptr, 10),
                        std::strtoull(arguments[2], nullptr, 10),
                        std::strtoull(arguments[3], nullptr, 10), std::atoi(arguments[4]),
                        {arguments + 5, arguments + count});
}
