#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/interval_oracle.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

/// Models and the files of their regions, compared with each other.
namespace planetree::oracle {

using octree::RegionBox;

inline constexpr double kNoWall = std::numeric_limits<double>::infinity();

inline std::array<double, 3> numbers(const Vec3& v) { return {v.x, v.y, v.z}; }

/// The walls of a region: the sides of its box that lie within the model's box.
class Walls {
 public:
  explicit Walls(const ModelInfo& info) {
    const auto lower = numbers(info.region_lower), upper = numbers(info.region_upper);
    const auto least = numbers(info.box_lower), greatest = numbers(info.box_upper);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower_[axis] = lower[axis] > least[axis] ? lower[axis] : -kNoWall;
      upper_[axis] = upper[axis] < greatest[axis] ? upper[axis] : kNoWall;
    }
  }
  bool any() const { return distance({0, 0, 0}) < kNoWall; }
  /// Distance to the nearest wall; negative beyond one.
  double distance(const Vec3& point) const {
    const auto at = numbers(point);
    double least = kNoWall;
    for (std::size_t axis = 0; axis < 3; ++axis)
      least = std::min({least, at[axis] - lower_[axis], upper_[axis] - at[axis]});
    return least;
  }

 private:
  std::array<double, 3> lower_{}, upper_{};
};

/// Counts of the cases met, so that a test cannot pass for want of cases.
struct Seen {
  int exact = 0, degraded = 0, within_error = 0, beyond = 0, inside = 0, outside = 0, unknown = 0;
};

/// A model, and the file of its region: of the triangles that touch a box.
class WholeAndRegion {
 public:
  WholeAndRegion(const Soup& soup, const RegionBox& box, double size = 1,
                 std::uint32_t page_bytes = 4096)
      : whole_(soup, {page_bytes, 1 << 20, 1}),
        part_(soup, {page_bytes, 1 << 20, 1, box}),
        walls_(part_.model().info()),
        intervals_(whole_.triangles()),
        size_(size) {}

  BuiltModel& whole() { return whole_; }
  BuiltModel& part() { return part_; }
  const Walls& walls() const { return walls_; }
  const Seen& seen() const { return seen_; }

  void check(const Vec3& query, const QueryOptions& options = {}) {
    const ClosestPoint truth = whole_.closest_point(query);
    const ClosestPoint answer = part_.closest_point(query, options);
    SCOPED_TRACE(testing::Message() << "at " << query.x << ' ' << query.y << ' ' << query.z);
    check_interval(query, truth, answer);
    if (answer.status == Status::kExact)
      expect_same_bits(answer, without_unknown_side(answer, truth));
    check_status(query, options, truth, answer);
    check_side(query, options, truth, answer);
  }

 private:
  // Without a side, normals follow the orientation of the mesh. They are sums in the order of a
  // tree, so their last bits may differ.
  static ClosestPoint without_unknown_side(const ClosestPoint& answer, ClosestPoint truth) {
    const Vec3 &n = answer.normal, &m = truth.normal;
    const double along = n.x * m.x + n.y * m.y + n.z * m.z;
    if ((answer.side == Side::kUnknown ? std::fabs(along) : along) > 1 - 1e-14) truth.normal = n;
    if (answer.side == Side::kUnknown) truth.side = Side::kUnknown;
    return truth;
  }

  void check_interval(const Vec3& query, const ClosestPoint& truth, const ClosestPoint& answer) {
    EXPECT_TRUE(intervals_.none_nearer(query, answer.lower)) << answer.lower;
    EXPECT_TRUE(answer.upper == kNoWall || intervals_.reaches(query, truth.triangle, answer.upper));
    EXPECT_LT(answer.lower, answer.upper);
    if (walls_.distance(query) < 0 && answer.status != Status::kBeyondMaxDistance) {
      EXPECT_EQ(answer.lower, 0);
    }
  }

  void check_status(const Vec3& query, const QueryOptions& options, const ClosestPoint& truth,
                    const ClosestPoint& answer) {
    const bool plain =
        options.max_error == 0 && options.max_distance == kNoWall && options.max_work > 1000;
    const double wall_margin = walls_.distance(query) - size_ * 1e-10;
    if (plain && truth.upper < wall_margin) {
      EXPECT_EQ(answer.status, answer.side == Side::kUnknown ? Status::kDegraded : Status::kExact);
    }
    if (plain && truth.lower > wall_margin + size_ * 2e-10) {
      EXPECT_EQ(answer.status, Status::kDegraded);
    }
    if (answer.status == Status::kWithinError) {
      EXPECT_LE(answer.upper - answer.lower, options.max_error);
    }
    seen_.exact += answer.status == Status::kExact;
    seen_.degraded += answer.status == Status::kDegraded;
    seen_.within_error += answer.status == Status::kWithinError;
    seen_.beyond += answer.status == Status::kBeyondMaxDistance;
  }

  void check_side(const Vec3& query, const QueryOptions& options, const ClosestPoint& truth,
                  const ClosestPoint& answer) {
    const Containment alone = part_.probe().contains(query);
    seen_.inside += answer.side == Side::kInside;
    seen_.outside += answer.side == Side::kOutside;
    seen_.unknown += answer.side == Side::kUnknown;
    const bool certain = walls_.distance(query) >= 0 || !walls_.any();
    EXPECT_EQ(alone.side, certain ? truth.side : Side::kUnknown);
    if (options.max_work > 1000) {
      EXPECT_EQ(answer.side, alone.side);
    }
  }

  BuiltModel whole_, part_;
  const Walls walls_;
  const IntervalOracle intervals_;
  const double size_;
  Seen seen_;
};

// An ulp beside `at`, unless the model frame rounds that away.
inline double beside(double at, bool above, double size) {
  if (at == 0) return above ? size * 0x1p-60 : size * -0x1p-60;
  return std::nextafter(at, above ? kNoWall : -kNoWall);
}

/// A point in, on or around a box.
inline Vec3 query_about(Random& random, const RegionBox& box, double size) {
  const auto lower = numbers(box.lower), upper = numbers(box.upper);
  std::array<double, 3> at{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    at[axis] = random.between(lower[axis], upper[axis]);
    switch (random.below(10)) {
      case 0:
        at[axis] = lower[axis];
        break;
      case 1:
        at[axis] = upper[axis];
        break;
      case 2:
        at[axis] = beside(random.one_in(2) ? lower[axis] : upper[axis], random.one_in(2), size);
        break;
      case 3:
        at[axis] += random.either_sign() * size;
        break;
      default:
        break;
    }
  }
  return {at[0], at[1], at[2]};
}

inline Vec3 least(const Vec3& a, const Vec3& b) {
  return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
}
inline Vec3 greatest(const Vec3& a, const Vec3& b) {
  return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
}

/// A box that some triangle touches: around a point of one, between vertices, flat, or a single
/// point.
inline RegionBox random_box(Random& random, const Soup& soup, double size) {
  const Corners& triangle = soup[random.below(soup.size())];
  const Vec3 corner = triangle[random.below(3)];
  const Vec3 other = soup[random.below(soup.size())][random.below(3)];
  const Vec3 point = random.one_in(2) ? corner : (corner + triangle[random.below(3)]) * 0.5;
  // The point may be this far off the triangle because of rounding.
  const double margin = size * 1e-12;
  Vec3 first = random.in_some_cube(-6, 0), second = random.in_some_cube(-6, 0);
  first = {std::fabs(first.x) * size, std::fabs(first.y) * size, std::fabs(first.z) * size};
  second = {std::fabs(second.x) * size, std::fabs(second.y) * size, std::fabs(second.z) * size};
  const Vec3 about{margin, margin, margin};
  switch (random.below(6)) {
    case 0:
      return {least(corner, other), greatest(corner, other)};
    case 1:
      return {corner, corner};
    case 2: {
      RegionBox box{point - first - about, point + second + about};
      box.lower.z = box.upper.z = corner.z;
      box.lower = least(box.lower, corner);
      box.upper = greatest(box.upper, corner);
      return box;
    }
    case 3:
      return {point - first * 1e3 - about, point + second + about};
    default:
      return {point - first - about, point + second + about};
  }
}

// A query that the model frame does not round.
inline Vec3 some_query(Random& random, const Soup& soup, const RegionBox& box, double size) {
  const Vec3 query =
      random.one_in(3) ? nasty_query(random, soup, size) : query_about(random, box, size);
  const auto flushed = [&](double at) { return std::fabs(at) < size * 0x1p-1000 ? 0 : at; };
  return {flushed(query.x), flushed(query.y), flushed(query.z)};
}

}  // namespace planetree::oracle
