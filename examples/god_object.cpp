// A god-object between two models that move: a session of a haptic device in a scene.
//
// god_object MODEL.ptree
//   The hand draws a ball through two copies of a model, of which one turns and one swings. The
//   ball, the god-object, stays outside of both (Zilles and Salisbury, 1995). While the copies move
//   it gives way to them, and then it follows the hand by first contacts and slides along the
//   surfaces; a spring to the hand gives the force. All queries of the loop are in real time. After
//   each tick, a second probe, which waits for its pages, judges whether the ball is outside; the
//   status is 1 if it ever was not.

#include <planetree/planetree.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>

using planetree::Vec3;

namespace {

constexpr int kTicks = 3000;
constexpr double kSeconds = 0.001;  // of a tick

Vec3 sum(const Vec3& a, const Vec3& b, double times) {
  return {a.x + b.x * times, a.y + b.y * times, a.z + b.z * times};
}
double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
double length(const Vec3& a) { return std::sqrt(dot(a, a)); }

// A pose turned about z by an angle, with the model's centre at a place.
planetree::Pose turned(double angle, const Vec3& centre, const Vec3& place) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {{std::cos(angle / 2), 0, 0, std::sin(angle / 2)},
          {place.x - (c * centre.x - s * centre.y), place.y - (s * centre.x + c * centre.y),
           place.z - centre.z}};
}

// A copy of the model that turns about its centre while it swings along x.
struct Part {
  planetree::InstanceId instance;
  Vec3 place;    // of its centre
  double speed;  // radians a second
  double swing;  // how far it goes to either side
  planetree::Pose pose_at(double t, const Vec3& centre) const {
    return turned(speed * t, centre, sum(place, {1, 0, 0}, swing * std::sin(t)));
  }
};

class GodObject {
 public:
  GodObject(const Vec3& centre, double radius) : centre_(centre), radius_(radius) {}

  // Gives way to what has come nearer than the ball may be: the way out leads along the normal of
  // the nearest surface, and of the next nearest where that is near too. `options` are those of
  // its queries. Returns whether the ball is certainly free.
  bool give_way(planetree::SceneProbe& probe, const planetree::QueryOptions& options) {
    constexpr int kMaxSteps = 8;
    for (int step = 0; step < kMaxSteps; ++step) {
      const auto nearest = probe.closest_point(centre_, options);
      const bool is_outside = nearest.side == planetree::Side::kOutside;
      if (is_outside && nearest.lower >= radius_ + gap() / 2) return true;
      if (nearest.status != planetree::Status::kExact) return false;
      centre_ = sum(centre_, nearest.normal, radius_ + gap() - nearest.signed_distance());
      ++pushed;
    }
    return false;
  }

  // Follows the hand: straight on, then along the surface that stopped it.
  void follow(planetree::SceneProbe& probe, const Vec3& hand,
              const planetree::QueryOptions& options) {
    Vec3 motion = sum(hand, centre_, -1);
    for (int move = 0; move < 3 && length(motion) > gap(); ++move) {
      const auto contact =
          probe.first_contact({centre_, sum(centre_, motion, 1), radius_}, 0, options);
      const double free = std::clamp(contact.t_lower, 0.0, 1.0);
      const double share = contact.free ? 1 : std::max(0.0, free - gap() / length(motion));
      centre_ = sum(centre_, motion, share);
      uncertain += contact.status == planetree::Status::kDegraded;
      if (contact.free || contact.status == planetree::Status::kDegraded) return;
      ++touched;
      motion = sum({}, motion, 1 - share);
      motion = sum(motion, contact.at.normal, -std::min(0.0, dot(motion, contact.at.normal)));
    }
  }

  const Vec3& centre() const { return centre_; }
  double radius() const { return radius_; }
  double gap() const { return radius_ / 100; }

  int pushed = 0, touched = 0, uncertain = 0;

 private:
  Vec3 centre_;
  double radius_;
};

struct Session {
  int waited = 0, inside = 0;
  double greatest_force = 0, nearest = 1e300;
};

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: god_object MODEL.ptree\n");
    return 2;
  }
  auto scene = planetree::Scene::create({.memory_budget_bytes = std::uint64_t{32} << 20});
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().text);
    return 1;
  }
  const auto first = scene->add(arguments[1]), second = scene->add(arguments[1]);
  auto probe = planetree::SceneProbe::create(*scene), judge = planetree::SceneProbe::create(*scene);
  if (!first || !second || !probe || !judge) {
    std::fprintf(stderr, "the scene could not be made\n");
    return 1;
  }
  const planetree::ModelInfo& info = **scene->info(*first);
  const Vec3 size = sum(info.box_upper, info.box_lower, -1);
  const Vec3 centre = sum(info.box_lower, size, 0.5);
  const double across = std::max({size.x, size.y, size.z});
  const Part parts[] = {{*first, {-0.8 * across, 0, 0}, 0.4, 0.05 * across},
                        {*second, {0.8 * across, 0, 0}, -0.3, -0.05 * across}};
  GodObject ball({0, 0, 1.5 * across}, across / 50);
  planetree::QueryOptions now;
  now.wait = planetree::Wait::kNever;
  Session session;
  for (int tick = 0; tick < kTicks; ++tick) {
    const double t = tick * kSeconds;
    for (const Part& part : parts)
      if (!scene->set_pose(part.instance, part.pose_at(t, centre))) return 1;
    // From above, down between the copies, and into one and the other.
    const Vec3 hand{across * std::sin(2 * t), 0, across * std::max(0.0, 1.5 - 2 * t)};
    probe->motion(ball.centre(), {});
    // Where pages lack, a device would hold its last force until they are there. A simulation,
    // whose time can stand still, waits for them instead.
    if (!ball.give_way(*probe, now)) {
      ++session.waited;
      ball.give_way(*probe, {});
    }
    ball.follow(*probe, hand, now);
    session.greatest_force = std::max(session.greatest_force, length(sum(ball.centre(), hand, -1)));

    const auto truth = judge->closest_point(ball.centre());
    const bool is_outside = judge->contains(ball.centre()).side == planetree::Side::kOutside;
    session.inside += !is_outside || truth.distance < ball.radius();
    session.nearest = std::min(session.nearest, truth.distance);
  }
  std::printf("%d ticks: touched %d times, gave way %d times, not certain %d times, waited in %d\n",
              kTicks, ball.touched, ball.pushed, ball.uncertain, session.waited);
  std::printf("greatest force %.3g times the stiffness; inside in %d ticks; nearest %.6f radii\n",
              session.greatest_force, session.inside, session.nearest / ball.radius());
  return session.inside == 0 && ball.touched > 0 && ball.pushed > 0 ? 0 : 1;
}
