#include "bench/workloads.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "octree/geometry/octcode.h"

namespace planetree::bench {
namespace {

Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vec3 operator*(const Vec3& a, double s) { return {a.x * s, a.y * s, a.z * s}; }
double length(const Vec3& a) { return std::sqrt(a.x * a.x + a.y * a.y + a.z * a.z); }

class QueryMaker {
 public:
  QueryMaker(const Box& box, const SurfaceOf& surface, std::uint64_t seed)
      : box_(box), surface_(surface), random_(seed) {}

  Vec3 uniform() {
    const Vec3 size = box_.upper - box_.lower;
    return box_.lower + Vec3{size.x * around(), size.y * around(), size.z * around()};
  }

  Vec3 near() {
    const double reach = 0.001 * box_.diagonal();
    const Vec3 on = surface_(uniform()).point;
    return on + Vec3{sway(), sway(), sway()} * reach;
  }

  std::vector<Vec3> path(std::size_t count, double step) {
    std::vector<Vec3> points(count);
    const double reach = 0.002 * box_.diagonal();
    Vec3 at = near();
    Vec3 heading{1, 0, 0};
    for (Vec3& point : points) {
      heading = heading + Vec3{sway(), sway(), sway()} * 0.3;
      heading = heading * (1 / length(heading));
      at = at + heading * (step * box_.diagonal());
      const ClosestPoint nearest = surface_(at);
      if (nearest.distance > reach)
        at = nearest.point + (at - nearest.point) * (reach / nearest.distance);
      point = at;
    }
    return points;
  }

  std::vector<Vec3> jumps(std::size_t count, std::size_t length, double step) {
    std::vector<Vec3> points;
    while (points.size() < count) {
      const std::vector<Vec3> piece = path(std::min(length, count - points.size()), step);
      points.insert(points.end(), piece.begin(), piece.end());
    }
    return points;
  }

  // Bisects along the inward normal of a surface point for the last point to which that surface
  // point is the nearest.
  Vec3 medial() {
    const ClosestPoint from = surface_(uniform());
    double near = 0, far = box_.diagonal();
    for (int i = 0; i < 40; ++i) {
      const double middle = (near + far) / 2;
      const double distance = surface_(from.point - from.normal * middle).distance;
      (distance < middle * (1 - 1e-9) ? far : near) = middle;
    }
    return from.point - from.normal * near;
  }

 private:
  double around() { return std::uniform_real_distribution<double>(-0.1, 1.1)(random_); }
  double sway() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

  Box box_;
  const SurfaceOf& surface_;
  std::mt19937_64 random_;
};

}  // namespace

double Box::diagonal() const { return length(upper - lower); }

std::string name_of(Workload workload) {
  switch (workload) {
    case Workload::kUniform:
      return "uniform";
    case Workload::kNear:
      return "near";
    case Workload::kPath:
      return "path";
    case Workload::kContact:
      return "contact";
    case Workload::kTeleport:
      return "teleport";
    case Workload::kMedial:
      return "medial";
  }
  return "";
}

std::vector<Vec3> make_queries(Workload workload, const Box& box, const SurfaceOf& surface,
                               std::size_t count, std::uint64_t seed) {
  QueryMaker maker(box, surface, seed);
  switch (workload) {
    case Workload::kPath:
      return maker.path(count, 0.0005);
    case Workload::kContact:
      return maker.path(count, 0.00005);
    case Workload::kTeleport:
      return maker.jumps(count, 50, 0.00005);
    default:
      break;
  }
  std::vector<Vec3> queries(count);
  for (Vec3& query : queries)
    query = workload == Workload::kNear     ? maker.near()
            : workload == Workload::kMedial ? maker.medial()
                                            : maker.uniform();
  return queries;
}

void sort_on_curve(const Box& box, std::vector<Vec3>& points) {
  const auto cell = [](double at, double lower, double upper) {
    const double share = (at - lower) / (upper - lower);
    return static_cast<std::uint32_t>(std::clamp(share, 0.0, 1.0) * ((1 << octree::kLevels) - 1));
  };
  std::sort(points.begin(), points.end(), [&](const Vec3& a, const Vec3& b) {
    const auto code = [&](const Vec3& p) {
      return octree::morton_code(cell(p.x, box.lower.x, box.upper.x),
                                 cell(p.y, box.lower.y, box.upper.y),
                                 cell(p.z, box.lower.z, box.upper.z));
    };
    return code(a) < code(b);
  });
}

}  // namespace planetree::bench
