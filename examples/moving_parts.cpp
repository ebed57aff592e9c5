// Two models that move, touched by a ball: a session of a haptic device in a scene.
//
// moving_parts MODEL.ptree
//   One copy of a model turns about its centre, another one swings past it, and a ball rests
//   between them. Each tick the copies move, and the ball gives way: it goes from where it is to
//   where the hand wants it, up to the first contact with either copy while they move (the
//   god-object method).

#include <planetree/planetree.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <thread>

using planetree::Vec3;

namespace {

constexpr int kTicks = 2000;
constexpr double kSeconds = 0.001;  // of a tick

// A pose turned about z by an angle, whose centre is at a place.
planetree::Pose turned(double angle, const Vec3& centre, const Vec3& place) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{std::cos(angle / 2), 0, 0, std::sin(angle / 2)},
          {place.x - (c * centre.x - s * centre.y), place.y - (s * centre.x + c * centre.y),
           place.z - centre.z}};
}

// The twist of such a pose that turns at a speed, while its centre moves at a velocity.
planetree::Twist twist(double speed, const planetree::Pose& pose, const Vec3& place,
                       const Vec3& velocity) {
  const Vec3 arm{pose.translation.x - place.x, pose.translation.y - place.y, 0};
  return {{velocity.x - speed * arm.y, velocity.y + speed * arm.x, velocity.z}, {0, 0, speed}};
}

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: moving_parts MODEL.ptree\n");
    return 2;
  }
  auto scene = planetree::Scene::create({.memory_budget_bytes = std::uint64_t{32} << 20});
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().text);
    return 1;
  }
  const auto first = scene->add(arguments[1]), second = scene->add(arguments[1]);
  auto probe = planetree::SceneProbe::create(*scene);
  if (!first || !second || !probe) {
    std::fprintf(stderr, "%s\n",
                 !first    ? first.error().text
                 : !second ? second.error().text
                           : probe.error().text);
    return 1;
  }
  const planetree::ModelInfo& info = **scene->info(*first);
  const Vec3 size = sum(info.box_upper, info.box_lower, -1);
  const Vec3 centre = sum(info.box_lower, size, 0.5);
  const double length = std::max({size.x, size.y, size.z}), radius = length / 50;

  // The hand wants the ball to stay here.
  const Vec3 hand{0, 0, 0};
  Vec3 ball = hand;
  int touched = 0, pushed = 0, uncertain = 0;
  double farthest = 0;
  auto next = std::chrono::steady_clock::now();
  for (int tick = 0; tick < kTicks; ++tick) {
    const double t = tick * kSeconds;
    std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
    // The first copy stands left of the ball and turns; the second one comes from the right.
    const Vec3 left{-length, 0, 0}, right{length * (1.2 - 0.4 * t), 0, 0};
    const planetree::Pose turning = turned(t, centre, left), coming = turned(0.3, centre, right);
    if (!scene->set_pose(*first, turning, twist(1, turning, left, {})) ||
        !scene->set_pose(*second, coming, {{-0.4 * length, 0, 0}, {}}))
      return 1;

    planetree::QueryOptions now;
    now.wait = planetree::Wait::kNever;
    // Away from what has come near since the last tick, then towards the hand.
    const auto nearest = probe->closest_point(ball, now);
    if (nearest.status == planetree::Status::kExact && nearest.signed_distance() < radius) {
      ball = sum(ball, nearest.normal, 1.01 * radius - nearest.signed_distance());
      ++pushed;
    }
    const auto contact = probe->first_contact({ball, hand, radius}, kSeconds, now);
    uncertain += contact.status == planetree::Status::kDegraded;
    touched += contact.instance != planetree::kNoInstance;
    const double free = std::clamp(contact.t_lower, 0.0, 1.0);
    ball = sum(ball, sum(hand, ball, -1), contact.free ? 1 : 0.99 * free);
    farthest = std::max(farthest, std::sqrt(ball.x * ball.x + ball.y * ball.y + ball.z * ball.z));
    probe->motion(ball, {});
  }
  std::printf("%d ticks: touched in %d, pushed in %d, not certain in %d; pushed away by %.3f\n",
              kTicks, touched, pushed, uncertain, farthest);
  const planetree::SceneStats stats = scene->stats();
  std::printf("%u instances of %u model, %.1f of %.1f MB\n", stats.instances, stats.models,
              static_cast<double>(stats.arena_bytes + stats.model_bytes + stats.table_bytes) / 1e6,
              static_cast<double>(stats.budget_bytes) / 1e6);
  return touched > 0 && farthest > 0 ? 0 : 1;
}
