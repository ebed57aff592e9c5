#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <span>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tests/fuzz/expectation.h"
#include "tests/fuzz/forging_hooks.h"
#include "tests/fuzz/memory_file.h"

/// Opens whole .ptree files whose hashes are right and whose contents are forged, and queries them.
///
/// No answer may be NaN or have an empty interval, whatever the pages say, and a query may visit no
/// more records than they hold.
namespace planetree {
namespace {

bool is_finite(const Vec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

// A forged scale takes points beyond the range of doubles.
bool is_number(const Vec3& v) { return !std::isnan(v.x) && !std::isnan(v.y) && !std::isnan(v.z); }

bool is_unit(const Vec3& n) { return std::abs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-9; }

void check(const ClosestPoint& answer, const QueryOptions& options) {
  const bool has_distance = (options.parts & (kDistance | kNormal)) != 0;
  expect(answer.status != Status::kBadQuery);
  expect(answer.lower >= 0 && answer.lower < answer.upper);
  expect(answer.distance >= 0 && is_number(answer.point) && is_finite(answer.barycentric));
  if (answer.status == Status::kExact && has_distance)
    expect(answer.lower <= answer.distance && answer.distance <= answer.upper);
  expect(is_unit(answer.normal));
}

void check(const RayHit& hit) {
  expect(!std::isnan(hit.t) && hit.t >= 0 && !std::isnan(hit.t_lower) && !std::isnan(hit.t_upper));
  expect(hit.status != Status::kBadQuery && hit.t_lower >= 0);
  expect((hit.triangle != kNoTriangle) == std::isfinite(hit.t));
  if (hit.triangle == kNoTriangle) return;
  expect(hit.t_lower <= hit.t && hit.t <= hit.t_upper);
  expect(is_number(hit.point) && is_finite(hit.barycentric) && is_unit(hit.normal));
}

void check(const FirstContact& contact) {
  expect(contact.status != Status::kBadQuery && contact.t >= 0 && contact.t_lower >= 0);
  expect(contact.t_lower <= contact.t && contact.t <= contact.t_upper);
  expect(contact.t <= 1 || std::isinf(contact.t));
  expect(!contact.free || (std::isinf(contact.t_lower) && contact.status == Status::kExact));
  const ClosestPoint& at = contact.at;
  expect((at.triangle != kNoTriangle) == std::isfinite(contact.t));
  if (at.triangle == kNoTriangle) return;
  expect(at.lower >= 0 && at.lower < at.upper && at.distance >= 0 && is_number(at.point));
  expect(is_finite(at.barycentric) && is_unit(at.normal));
}

/// Points in the model's box and around it, and some that depend on nothing.
std::vector<Vec3> points_for(const ModelInfo& info) {
  const Vec3 &low = info.box_lower, &high = info.box_upper;
  std::vector<Vec3> points = {low, high, {0, 0, 0}, {0.3, 0.4, 0.5}, {1e30, -1e9, 1}};
  const auto between = [](double a, double b, double t) { return a * (1 - t) + b * t; };
  for (const double t : {0.5, 0.25, 0.8, -0.4})
    points.push_back({between(low.x, high.x, t), between(low.y, high.y, 1 - t),
                      between(low.z, high.z, 0.9 * t)});
  std::erase_if(points, [](const Vec3& point) { return !is_finite(point); });
  return points;
}

std::vector<QueryOptions> all_options() {
  QueryOptions exact, rough, instant, side, starved;
  rough.max_error = 0.1;
  rough.max_distance = 0.7;
  instant.wait = Wait::kNever;
  side.parts = kSide;
  side.max_work = 50;
  starved.parts = kDistance | kNormal;
  starved.max_work = 3;
  return {exact, rough, instant, side, starved};
}

/// Calls a query and expects it to visit no more records than the pages hold.
template <class Query>
auto bounded(const Model& model, const Query& query) {
  const std::uint64_t records = model.info().nodes + model.info().blocks;
  const Stats before = model.stats();
  const auto answer = query();
  const Stats after = model.stats();
  const std::uint64_t lookups =
      after.page_hits + after.page_misses - before.page_hits - before.page_misses;
  expect(lookups <= 16 * records + 1000);
  return answer;
}

void query_points(const Model& model, Probe& probe, const std::vector<Vec3>& points,
                  const QueryOptions& options) {
  for (const Vec3& point : points) {
    const Containment side = bounded(model, [&] {
      check(probe.closest_point(point, options), options);
      return probe.contains(point, options);
    });
    expect(side.status != Status::kBadQuery);
  }
  std::vector<ClosestPoint> answers(points.size());
  std::vector<Containment> sides(points.size());
  probe.closest_points(points, answers, options);
  probe.contains(points, sides, options);
  for (const ClosestPoint& answer : answers) check(answer, options);
}

/// Triangles by their indices: each is found, or a reason is given.
void read_triangles(const Model& model) {
  const ModelInfo& info = model.info();
  for (const std::uint64_t index : {std::uint64_t{0}, std::uint64_t{1}, info.triangles / 2,
                                    info.triangles - 1, info.triangles + 5, kNoTriangle}) {
    const auto triangle = model.triangle(index);
    if (!triangle) {
      expect(triangle.error().text[0] != 0);
      continue;
    }
    expect(info.attributes != 0);
    for (const Vec3& corner : triangle->corners) expect(is_number(corner));
    [[maybe_unused]] const volatile std::uint8_t red = triangle->color_at({0.5, 0.25, 0.25}).red;
  }
}

/// Rays and moving balls from each point to another.
void query_ways(const Model& model, Probe& probe, const std::vector<Vec3>& points,
                const QueryOptions& options) {
  std::vector<Ray> rays;
  std::vector<Sweep> sweeps;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 &from = points[i], &to = points[(3 * i + 1) % points.size()];
    const Vec3 along{to.x - from.x, to.y - from.y, to.z - from.z};
    if (is_finite(along) && (along.x != 0 || along.y != 0 || along.z != 0))
      rays.push_back(i % 2 == 0 ? Ray{from, along} : Ray{from, along, 0.25, 1});
    sweeps.push_back({from, to, i % 3 == 0 ? 0 : 0.05 * static_cast<double>(i)});
  }
  std::vector<RayHit> hits(rays.size()), all(5);
  for (const Ray& ray : rays) {
    check(bounded(model, [&] { return probe.first_hit(ray, options); }));
    const Found found = bounded(model, [&] { return probe.all_hits(ray, all, options); });
    expect(found.count <= all.size());
    for (std::size_t i = 0; i < found.count; ++i) {
      check(all[i]);
      expect(all[i].triangle != kNoTriangle && (i == 0 || all[i - 1].t <= all[i].t));
    }
  }
  for (const Sweep& sweep : sweeps)
    check(bounded(model, [&] { return probe.first_contact(sweep, options); }));
  std::vector<FirstContact> contacts(sweeps.size());
  probe.first_hits(rays, hits, options);
  probe.first_contacts(sweeps, contacts, options);
  for (const RayHit& hit : hits) check(hit);
  for (const FirstContact& contact : contacts) check(contact);
}

void check(const Found& set, std::span<const ClosestPoint> found, const QueryOptions& options) {
  expect(set.count <= found.size());
  for (std::size_t i = 0; i < set.count; ++i) {
    check(found[i], options);
    expect(i == 0 || found[i - 1].distance <= found[i].distance);
  }
}

// Triangles and contacts about a point.
void query_sets(Probe& probe, const Vec3& point, const QueryOptions& options) {
  std::array<ClosestPoint, 20> found;
  check(probe.nearest_triangles(point, found, options), found, options);
  for (const double radius : {0.3, 1e9}) {
    check(probe.triangles_within(point, radius, found, options), found, options);
    check(probe.contacts(point, radius, found, options), found, options);
  }
}

void query(const Model& model) {
  Result<Probe> probe = Probe::create(model);
  if (!probe) return;
  const std::vector<Vec3> points = points_for(model.info());
  for (const QueryOptions& options : all_options()) {
    query_points(model, *probe, points, options);
    query_ways(model, *probe, points, options);
    for (const Vec3& point : points) query_sets(*probe, point, options);
  }
}

void open_and_query(const std::filesystem::path& path) {
  OpenOptions options;
  options.memory_budget_bytes = std::uint64_t{16} << 20;
  options.max_probes = 1;
  options.locking = Locking::kNever;
  options.use_io_uring = false;
  const Result<Model> model = Model::open(path, options);
  if (!model) return expect(model.error().text[0] != 0);
  read_triangles(*model);
  query(*model);
}

}  // namespace
}  // namespace planetree

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const planetree::MemoryFile file(data, size);
  planetree::open_and_query(file.path());
  return 0;
}
