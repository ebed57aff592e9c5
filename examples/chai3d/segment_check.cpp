// Pushes the proxy of a haptic device through a model, by the collisions that CHAI3D's finger-proxy
// algorithm would ask for, but without CHAI3D.
//
// segment_check MODEL.ptree
//   The pages of the model are not in memory at first. The status is 1 if the ball was ever inside.

#include <chrono>
#include <cstdio>
#include <thread>

#include "examples/chai3d/segment_collision.h"

using planetree::Vec3;

namespace {

constexpr int kTicks = 400;

Vec3 between(const Vec3& a, const Vec3& b, double share) {
  return {a.x + share * (b.x - a.x), a.y + share * (b.y - a.y), a.z + share * (b.z - a.z)};
}

/// What a push came to.
struct Push {
  int contacts = 0, uncertain = 0, inside = 0, left = 0;
};

/// Pushes a ball from outside to the other side, and draws it back.
Push push(SegmentCollision& collision, planetree::Probe& judge, const Vec3& from, const Vec3& to,
          double radius) {
  const double gap = radius / 1000;  // CHAI3D's epsilon
  Push result;
  Vec3 ball = from;
  auto next = std::chrono::steady_clock::now();
  for (int tick = 0; tick < 2 * kTicks; ++tick) {
    std::this_thread::sleep_until(next += std::chrono::milliseconds(1));
    const bool is_pushed = tick < kTicks;
    const Vec3 device = is_pushed ? between(from, to, tick / (kTicks - 1.0)) : from;
    const auto contact = collision.first(ball, device, radius);
    if (!contact) {
      ball = device;
      result.left += !is_pushed;
    } else {
      ++result.contacts;
      result.uncertain += !contact->is_certain;
      const double way = std::sqrt(contact->square_distance);
      if (way > gap) ball = between(ball, contact->centre, (way - gap) / way);
    }
    const auto nearest = judge.closest_point(ball);  // waits for its pages
    result.inside += nearest.signed_distance() < radius * (1 - 1e-6);
  }
  return result;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: segment_check MODEL.ptree\n");
    return 2;
  }
  // The judge has a model of its own, so that its pages are not those of the ball.
  const auto model = planetree::Model::open(arguments[1]);
  const auto judged = planetree::Model::open(arguments[1]);
  if (!model || !judged) {
    std::fprintf(stderr, "%s\n", (model ? judged : model).error().text);
    return 1;
  }
  auto probe = planetree::Probe::create(*model), judge = planetree::Probe::create(*judged);
  if (!probe || !judge) {
    std::fprintf(stderr, "%s\n", (probe ? judge : probe).error().text);
    return 1;
  }
  const planetree::ModelInfo& info = model->info();
  const Vec3 middle = between(info.core_lower, info.core_upper, 0.5);
  const double length = info.core_upper.x - info.core_lower.x;
  SegmentCollision collision(std::move(*probe));
  const Push result = push(collision, *judge, {middle.x - length, middle.y, middle.z},
                           {middle.x + length, middle.y, middle.z}, length / 50);
  std::printf("%d contacts, %d of them not certain, %d ticks inside; drawn back in %d ticks\n",
              result.contacts, result.uncertain, result.inside, result.left);
  return result.inside == 0 && result.contacts > result.uncertain && result.left > 0 ? 0 : 1;
}
