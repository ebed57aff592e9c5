// Runs one kind of query again and again, to count its instructions under callgrind: a slowdown
// shows without a clock. Points are made and queried once before the counting begins.

#include <fmt/format.h>
#include <valgrind/callgrind.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <iostream>
#include <string>
#include <vector>

#include "bench/workloads.h"
#include "planetree/planetree.h"

namespace planetree::bench {
namespace {

struct Arguments {
  std::string model;
  std::string region;  // file of a region; empty: none
  std::string workload = "uniform";
  std::string part = "distance";
  std::size_t queries = 2000;
  std::uint32_t layers = kAllLayers;
  double max_error = 0;  // share of the diagonal
  double radius = 0;     // of a moving ball, share of its distance from the surface
  std::uint32_t max_work = QueryOptions::kNoLimit;
  bool never_wait = false;
  bool in_batch = false;
  bool on_curve = false;  // points in the order of a Morton curve
  std::uint32_t page_trace_capacity = 0;
};

QueryOptions options_of(const Arguments& arguments, const Box& box) {
  QueryOptions options;
  options.parts = arguments.part == "distance" ? kDistance : kAllParts;
  options.max_error = arguments.max_error * box.diagonal();
  options.max_work = arguments.max_work;
  options.wait = arguments.never_wait ? Wait::kNever : Wait::kForPages;
  return options;
}

// What is asked at each point: its nearest point, its side, the contacts of a ball there, the first
// contact on the way to the next point, or the first hit of the ray that begins there.
enum class Part { kNearest, kSide, kContacts, kSweep, kRay };

Part part_of(const std::string& name) {
  return name == "side"       ? Part::kSide
         : name == "contacts" ? Part::kContacts
         : name == "sweep"    ? Part::kSweep
         : name == "ray"      ? Part::kRay
                              : Part::kNearest;
}

struct Place {
  Vec3 point, next;
  double radius;  // of a ball there
};

double query(Probe& probe, const Place& place, Part part, const QueryOptions& options) {
  const auto& [point, next, radius] = place;
  switch (part) {
    case Part::kSide:
      return probe.contains(point, options).side == Side::kInside ? 1 : 0;
    case Part::kContacts: {
      std::array<ClosestPoint, 16> found;
      return static_cast<double>(probe.contacts(point, radius, found, options).count);
    }
    case Part::kSweep:
      return probe.first_contact({point, next, radius}, options).free ? 1 : 0;
    case Part::kRay: {
      const Vec3 direction{next.x - point.x, next.y - point.y, next.z - point.z};
      return probe.first_hit({point, direction}, options).triangle != kNoTriangle ? 1 : 0;
    }
    default:
      return probe.closest_point(point, options).distance;
  }
}

double query_all(Probe& probe, const std::vector<Place>& places, Part part,
                 const QueryOptions& options) {
  double sum = 0;
  for (const Place& place : places) sum += query(probe, place, part, options);
  return sum;
}

Result<Model> open(const std::string& path, std::uint32_t layers,
                   std::uint32_t page_trace_capacity = 0) {
  return Model::open(path, {.memory_budget_bytes = std::uint64_t{16} << 30,
                            .layers = layers,
                            .page_trace_capacity = page_trace_capacity});
}

// Where points are made: about the core of a model, or about its region.
Box box_of(const ModelInfo& info) {
  if (!info.has_region) return {info.core_lower, info.core_upper};
  const auto inner = [](const Vec3& a, const Vec3& b, auto of) {
    return Vec3{of(a.x, b.x), of(a.y, b.y), of(a.z, b.z)};
  };
  return {
      inner(info.region_lower, info.core_lower, [](double a, double b) { return a > b ? a : b; }),
      inner(info.region_upper, info.core_upper, [](double a, double b) { return a < b ? a : b; })};
}

// Makes points that a model answers exactly: in a region, those that no wall is nearer to.
std::vector<Vec3> make_points(const Model& model, Probe& probe, Workload workload,
                              std::size_t count) {
  const SurfaceOf surface = [&](const Vec3& query) { return probe.closest_point(query); };
  auto points = make_queries(workload, box_of(model.info()), surface, count, 1);
  std::erase_if(points, [&](const Vec3& point) {
    return model.info().has_region &&
           probe.closest_point(point, {.parts = kDistance}).status != Status::kExact;
  });
  return points;
}

// A ball at each point, on the way to the next one.
std::vector<Place> make_places(Probe& probe, const std::vector<Vec3>& points, double radius_share) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = probe.closest_point(points[i], {.parts = kDistance}).distance;
    places.push_back({points[i], points[(i + 1) % points.size()], radius_share * distance});
  }
  return places;
}

double query_batch(Probe& probe, const std::vector<Vec3>& points,
                   std::vector<ClosestPoint>& answers, const QueryOptions& options) {
  probe.closest_points(points, answers, options);
  double sum = 0;
  for (const ClosestPoint& answer : answers) sum += answer.distance;
  return sum;
}

int run(const Arguments& arguments) {
  const auto fail = [](const Error& error) {
    return std::cerr << "query_bench: " << error.text << '\n', 1;
  };
  const auto model = open(arguments.model, arguments.layers, arguments.page_trace_capacity);
  if (!model) return fail(model.error());
  const auto maker =
      open(arguments.region.empty() ? arguments.model : arguments.region, kAllLayers);
  if (!maker) return fail(maker.error());
  auto probe = Probe::create(*model), making = Probe::create(*maker);
  if (!probe || !making) return fail(probe ? making.error() : probe.error());
  for (const Workload workload : kWorkloads) {
    if (name_of(workload) != arguments.workload) continue;
    auto points = make_points(*maker, *making, workload, arguments.queries);
    const Box box = box_of(maker->info());
    if (arguments.on_curve) sort_on_curve(box, points);
    const QueryOptions options = options_of(arguments, box);
    const Part part = part_of(arguments.part);
    const auto places = make_places(*making, points, arguments.radius);
    query_all(*probe, places, part, {.parts = options.parts});
    query_all(*probe, places, part, options);
    std::vector<ClosestPoint> answers(points.size());
    CALLGRIND_START_INSTRUMENTATION;
    CALLGRIND_ZERO_STATS;
    const double sum = arguments.in_batch ? query_batch(*probe, points, answers, options)
                                          : query_all(*probe, places, part, options);
    CALLGRIND_STOP_INSTRUMENTATION;
    fmt::print("{:.17g} of {} points\n", sum, points.size());
    return 0;
  }
  std::cerr << "query_bench: there is no workload '" << arguments.workload << "'\n";
  return 2;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("One kind of query again and again, run by ./dev counts");
  app.add_option("model", arguments.model, "File that planetree build wrote")->required();
  app.add_option("--workload", arguments.workload, "uniform, near, path, contact, teleport, medial")
      ->capture_default_str();
  app.add_option(
         "--part", arguments.part,
         "distance, side or all of each point; contacts: those of a ball there; sweep: the "
         "first contact of the ball on the way to the next point; ray: the first hit of the "
         "ray to there")
      ->check(CLI::IsMember({"distance", "side", "all", "contacts", "sweep", "ray"}))
      ->capture_default_str();
  app.add_option("--queries", arguments.queries, "How many")->capture_default_str();
  app.add_option("--region", arguments.region,
                 "File of a region of the same mesh: make points there that both files answer "
                 "exactly");
  app.add_option("--layers", arguments.layers, "Layers to open: 1 distance, 2 side, 4 field; sums")
      ->capture_default_str();
  app.add_option("--max-error", arguments.max_error, "Allowed error, as a share of the diagonal")
      ->capture_default_str();
  app.add_option("--radius", arguments.radius,
                 "Radius of the ball, as a share of its distance from the surface")
      ->capture_default_str();
  app.add_option("--max-work", arguments.max_work, "Maximum units of work of a query");
  app.add_option("--page-trace", arguments.page_trace_capacity,
                 "Capacity of a page trace in words, whose cost then counts")
      ->capture_default_str();
  app.add_flag("--never-wait", arguments.never_wait, "Real-time queries; all pages are in memory");
  app.add_flag("--batch", arguments.in_batch, "Nearest points of a batch on one thread");
  app.add_flag("--on-curve", arguments.on_curve, "Points in the order of a Morton curve");
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
