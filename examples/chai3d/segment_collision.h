#pragma once

#include <planetree/planetree.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>

/// Collisions of a moving ball with a model, as the finger-proxy algorithm of a haptic library asks
/// for them: along a segment, in real time. Knows nothing of that library.
class SegmentCollision {
 public:
  struct Contact {
    planetree::Vec3 centre;      ///< of the ball where it stops: before it, the ball is free
    planetree::Vec3 normal;      ///< unit length, from the surface to the centre
    double square_distance = 0;  ///< from the start of the segment to that centre
    std::uint64_t triangle = planetree::kNoTriangle;  ///< kNoTriangle if it is not known
    bool is_certain = false;  ///< false: pages lacked, and the ball stops where they begin to lack
  };

  /// Takes a probe of its own.
  ///
  /// threads  those of the probe: one at a time
  explicit SegmentCollision(planetree::Probe probe) : probe_(std::move(probe)) {}

  /// Returns where a ball stops that moves from one place to another. Nothing if all of the way is
  /// certainly free. Where pages are missing, it stops at the end of the part that is certainly
  /// free, as at a wall across its way, so that it passes through no surface. The pages are then on
  /// their way.
  ///
  /// from, to, radius  model units
  std::optional<Contact> first(const planetree::Vec3& from, const planetree::Vec3& to,
                               double radius) noexcept {
    planetree::QueryOptions now;
    now.wait = planetree::Wait::kNever;
    const planetree::Vec3 motion{to.x - from.x, to.y - from.y, to.z - from.z};
    auto contact = probe_.first_contact({from, to, radius}, now);
    // A ball that touches a surface behind it may leave it: a ball that is smaller by rounding does
    // not touch it, and goes as far.
    if (is_found(contact) && contact.t == 0 && dot(contact.at.normal, motion) > 0 &&
        contact.at.distance > 0)
      contact = probe_.first_contact(
          {from, to, (1 - kRounding) * std::min(radius, contact.at.distance)}, now);
    if (contact.free) return std::nullopt;
    const double share = std::clamp(contact.t_lower, 0.0, 1.0);
    Contact stop;
    stop.centre = {from.x + share * motion.x, from.y + share * motion.y, from.z + share * motion.z};
    stop.square_distance = share * share * dot(motion, motion);
    stop.is_certain = is_found(contact) && contact.status == planetree::Status::kExact;
    if (stop.is_certain) {
      stop.triangle = contact.at.triangle;
      stop.normal = contact.at.normal;
    } else {
      stop.normal = against(motion);
    }
    return stop;
  }

 private:
  static constexpr double kRounding = 1e-9;

  static bool is_found(const planetree::FirstContact& contact) { return std::isfinite(contact.t); }
  static double dot(const planetree::Vec3& a, const planetree::Vec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
  }
  static planetree::Vec3 against(const planetree::Vec3& motion) {
    const double length = std::sqrt(dot(motion, motion));
    if (!(length > 0)) return {0, 0, 1};
    return {-motion.x / length, -motion.y / length, -motion.z / length};
  }

  planetree::Probe probe_;
};
