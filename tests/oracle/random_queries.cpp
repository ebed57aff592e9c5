#include "tests/oracle/random_queries.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>

#include "tests/oracle/closed_models.h"
#include "tests/oracle/interval_oracle.h"
#include "tests/oracle/limited_queries.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

constexpr double kScales[] = {1, 1e-300, 1e150, 37, 1e-12, 1e20, 1};
constexpr std::size_t kMaxTriangles = 500;

const NastyFamily& family_of(std::size_t number) {
  const std::size_t nasty = nasty_families().size();
  const std::size_t at = number % (nasty + closed_families().size());
  return at < nasty ? nasty_families()[at] : closed_families()[at - nasty];
}

double scale_of(std::size_t number) { return kScales[number % std::size(kScales)]; }

BuiltModel built_model(std::size_t number, Random& random) {
  Soup soup = family_of(number).make(random);
  if (soup.size() > kMaxTriangles) soup.resize(kMaxTriangles);
  return BuiltModel(scaled(std::move(soup), scale_of(number)), {4096, 1 << 20, 1});
}

double dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

double largest_coordinate(const Corners& triangle) {
  double largest = 0;
  for (const Vec3& p : triangle)
    largest = std::max({largest, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  return largest;
}

bool all_finite(const ClosestPoint& a) {
  const double numbers[] = {a.distance, a.lower,         a.upper,         a.point.x,
                            a.point.y,  a.point.z,       a.normal.x,      a.normal.y,
                            a.normal.z, a.barycentric.x, a.barycentric.y, a.barycentric.z};
  return std::ranges::all_of(numbers, [](double number) { return std::isfinite(number); });
}

class Judge {
 public:
  explicit Judge(QueriedModel& model)
      : model_(model),
        intervals_(model.built.triangles()),
        watertight_(model.built.model().info().watertight()),
        in_frame_(model.built.triangles()),
        limited_(model.built.path()) {
    // In the model frame, where the smallest subnormal numbers are rounded away.
    for (Corners& triangle : in_frame_)
      for (Vec3& corner : triangle) corner = in_frame(corner);
  }

  void check_query(const Vec3& query, QueryTally& tally) {
    const ClosestPoint answer = model_.built.closest_point(query);
    const std::size_t before = tally.misses();
    ++tally.queries;
    tally.not_finite += !all_finite(answer);
    tally.interval += !interval_holds(query, answer);
    judge_side(query, answer, tally);
    judge_normal(query, answer, tally);
    if (tally.misses() != before && tally.first_miss.empty())
      tally.first_miss = words(query, answer);
    judge_limited(query, tally);
  }

 private:
  // Options are drawn from random numbers of their own, so that they do not change the queries.
  void judge_limited(const Vec3& query, QueryTally& tally) {
    if (!limited_.agree(query, random_)) {
      ++tally.limited;
      if (tally.first_miss.empty())
        tally.first_miss = std::string(model_.family) + ": " + limited_.last_miss();
    }
    tally.limited_exact = limited_.exact();
  }

  Vec3 in_frame(const Vec3& p) const {
    const int exponent = model_.built.scale_exponent();
    return {std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
  }

  bool interval_holds(const Vec3& query, const ClosestPoint& a) const {
    const Status expected = a.side == Side::kUnknown ? Status::kDegraded : Status::kExact;
    return a.status == expected && a.triangle < model_.built.triangles().size() && 0 <= a.lower &&
           a.lower < a.upper && a.lower <= a.distance && a.distance <= a.upper &&
           intervals_.none_nearer(query, a.lower) && intervals_.reaches(query, a.triangle, a.upper);
  }

  Side true_side(const Vec3& query) const {
    const ModelInfo& info = model_.built.model().info();
    const Vec3 lower = in_frame(info.box_lower), upper = in_frame(info.box_upper);
    const Vec3 at = in_frame(query);
    if (at.x < lower.x || at.y < lower.y || at.z < lower.z || at.x > upper.x || at.y > upper.y ||
        at.z > upper.z)
      return Side::kOutside;
    return exact_side(at, in_frame_);
  }

  void judge_side(const Vec3& query, const ClosestPoint& answer, QueryTally& tally) {
    const Containment alone = model_.built.probe().contains(query);
    const std::optional<Side> expected = watertight_ ? true_side(query) : open_side(query);
    tally.sides += expected.has_value();
    tally.side += alone.side != answer.side || (expected && answer.side != *expected);
  }

  // No value if the winding number is too near one half to decide.
  std::optional<Side> open_side(const Vec3& query) const {
    const Vec3 at = in_frame(query);
    if (!std::isfinite(at.x) || !std::isfinite(at.y) || !std::isfinite(at.z)) return Side::kOutside;
    const OpenWinding winding = open_winding(at, in_frame_);
    if (winding.on_surface) return Side::kOnSurface;
    const long double size = std::fabs(winding.value);
    if (std::fabs(size - 0.5L) < 1e-3L) return std::nullopt;
    return size > 0.5L ? Side::kInside : Side::kOutside;
  }

  void judge_normal(const Vec3& query, const ClosestPoint& a, QueryTally& tally) const {
    bool good = std::fabs(dot(a.normal, a.normal) - 1) < 1e-15;
    const Vec3 way = query - a.point;
    // Not the length, which may overflow.
    const double reach = std::max({std::fabs(way.x), std::fabs(way.y), std::fabs(way.z)});
    // Faces without area have no normal: the answer is (0, 0, 1) then.
    const bool certain = a.normal.x != 0 || a.normal.y != 0 || a.normal.z != 1;
    if (certain && (a.side == Side::kInside || a.side == Side::kOutside) && std::isfinite(reach) &&
        a.triangle < model_.built.triangles().size() &&
        reach > 1e-9 * largest_coordinate(model_.built.triangles()[a.triangle])) {
      const Vec3 direction{way.x / reach, way.y / reach, way.z / reach};
      const double height = dot(direction, a.normal);
      good = good && (a.side == Side::kOutside ? height > -1e-6 : height < 1e-6);
      ++tally.normals;
    }
    tally.normal += !good;
  }

  std::string words(const Vec3& query, const ClosestPoint& a) const {
    char line[400];
    std::snprintf(line, sizeof line,
                  "%s: query %a %a %a, distance %a in [%a, %a], triangle %lld, side %d, "
                  "normal %g %g %g",
                  std::string(model_.family).c_str(), query.x, query.y, query.z, a.distance,
                  a.lower, a.upper, static_cast<long long>(a.triangle), static_cast<int>(a.side),
                  a.normal.x, a.normal.y, a.normal.z);
    return line;
  }

  QueriedModel& model_;
  IntervalOracle intervals_;
  bool watertight_;
  Soup in_frame_;
  LimitedQueries limited_;
  Random random_{1};
};

}  // namespace

std::string_view name_of(std::size_t number) { return family_of(number).name; }

QueriedModel::QueriedModel(std::size_t number)
    : family(family_of(number).name),
      closed(number % (nasty_families().size() + closed_families().size()) >=
             nasty_families().size()),
      scale(scale_of(number)),
      random(900000 + number),
      built(built_model(number, random)) {}

Vec3 QueriedModel::query() {
  const Soup& triangles = built.triangles();
  const auto anywhere = [](double low, double high, double share) {
    return low + share * (high - low);
  };
  const ModelInfo& info = built.model().info();
  switch (random.below(10)) {
    case 0: {
      const Vec3 at{random.between(-0.1, 1.1), random.between(-0.1, 1.1),
                    random.between(-0.1, 1.1)};
      return {anywhere(info.box_lower.x, info.box_upper.x, at.x),
              anywhere(info.box_lower.y, info.box_upper.y, at.y),
              anywhere(info.box_lower.z, info.box_upper.z, at.z)};
    }
    case 1: {
      const auto step = [&] { return (static_cast<double>(random.below(25)) - 4) / 16; };
      const double x = step(), y = step(), z = step();
      return Vec3{x, y, z} * scale;
    }
    case 2: {
      const Vec3 direction = random.in_cube();
      return direction * random.magnitude(40, 1020);
    }
    default:
      return nasty_query(random, triangles, scale);
  }
}

QueryTally& QueryTally::operator+=(const QueryTally& other) {
  queries += other.queries;
  sides += other.sides;
  limited_exact += other.limited_exact;
  normals += other.normals;
  not_finite += other.not_finite;
  interval += other.interval;
  side += other.side;
  normal += other.normal;
  limited += other.limited;
  if (first_miss.empty()) first_miss = other.first_miss;
  return *this;
}

QueryTally query_at_random(std::size_t number, std::size_t count) {
  QueriedModel model(number);
  Judge judge(model);
  QueryTally tally;
  for (std::size_t i = 0; i < count; ++i) judge.check_query(model.query(), tally);
  if (model.closed && !model.built.model().info().watertight()) {
    ++tally.side;
    tally.first_miss = std::string(model.family) + " is not watertight";
  }
  return tally;
}

}  // namespace planetree::oracle
