#include <algorithm>
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

void check(const ClosestPoint& answer, const QueryOptions& options) {
  const bool has_distance = (options.parts & (kDistance | kNormal)) != 0;
  expect(answer.status != Status::kBadQuery);
  expect(answer.lower >= 0 && answer.lower < answer.upper);
  expect(answer.distance >= 0 && is_number(answer.point) && is_finite(answer.barycentric));
  if (answer.status == Status::kExact && has_distance)
    expect(answer.lower <= answer.distance && answer.distance <= answer.upper);
  const Vec3& n = answer.normal;
  expect(std::abs(n.x * n.x + n.y * n.y + n.z * n.z - 1) < 1e-9);
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

void query(const Model& model) {
  Result<Probe> probe = Probe::create(model);
  if (!probe) return;
  const std::vector<Vec3> points = points_for(model.info());
  const std::uint64_t records = model.info().nodes + model.info().blocks;
  for (const QueryOptions& options : all_options()) {
    for (const Vec3& point : points) {
      const Stats before = model.stats();
      check(probe->closest_point(point, options), options);
      expect(probe->contains(point, options).status != Status::kBadQuery);
      const Stats after = model.stats();
      const std::uint64_t lookups =
          after.page_hits + after.page_misses - before.page_hits - before.page_misses;
      expect(lookups <= 16 * records + 1000);
    }
    std::vector<ClosestPoint> answers(points.size());
    std::vector<Containment> sides(points.size());
    probe->closest_points(points, answers, options);
    probe->contains(points, sides, options);
    for (const ClosestPoint& answer : answers) check(answer, options);
  }
}

void open_and_query(const std::filesystem::path& path) {
  OpenOptions options;
  options.memory_budget_bytes = std::uint64_t{16} << 20;
  options.max_probes = 1;
  options.locking = Locking::kNever;
  options.use_io_uring = false;
  const Result<Model> model = Model::open(path, options);
  if (model)
    query(*model);
  else
    expect(model.error().text[0] != 0);
}

}  // namespace
}  // namespace planetree

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const planetree::MemoryFile file(data, size);
  planetree::open_and_query(file.path());
  return 0;
}
