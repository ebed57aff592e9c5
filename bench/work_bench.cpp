// Counts the units of work of real-time queries, and under callgrind the instructions of a unit.
// `./dev work-units` runs it and divides. All pages are resident when the counting begins.

#include <fmt/format.h>
#include <valgrind/callgrind.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <iterator>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "octree/nearest/nearest.h"
#include "planetree/planetree.h"
#include "query/answer/closest_point.h"
#include "query/answer/side.h"
#include "query/model_state.h"
#include "query/probe_state.h"
#include "query/serve/page_accessor.h"

namespace planetree::bench {
namespace {

struct Arguments {
  std::string model;
  std::string part = "distance";
  std::string at = "box";
  std::size_t queries = 20;
  std::uint32_t max_work = QueryOptions::kRealTimeWork;
};

// Points in the model's box, and between them points on its middle planes, whose coordinates the
// vertices of many shapes have too.
std::vector<Vec3> points_in(const ModelInfo& info, std::size_t count) {
  std::mt19937_64 random(1);
  const auto at = [&](double lower, double upper, bool middle) {
    const double share = static_cast<double>(random() >> 11) * 0x1p-53;
    return lower + (upper - lower) * (middle ? 0.5 : share);
  };
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back({at(info.box_lower.x, info.box_upper.x, i % 4 == 1),
                      at(info.box_lower.y, info.box_upper.y, i % 4 >= 2),
                      at(info.box_lower.z, info.box_upper.z, i % 4 == 3)});
  return points;
}

// Moves each point to the triangle of a tree that is nearest to it: to a corner, the middle of an
// edge, the middle of a height, or the nearest point.
void move_to(const octree::TreeInfo& tree, query::ProbeState& probe, std::vector<Vec3>& points) {
  const query::Scale& scale = probe.model().geometry.scale;
  query::PageAccessor accessor(probe.reader(), Wait::kForPages);
  octree::TraversalStats work;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const octree::NearestAnswer nearest =
        octree::nearest(tree, scale.in(points[i]), {}, accessor.pages(), work);
    const auto& [a, b, c] = nearest.corners;
    const octree::Point places[] = {a, (a + b) * 0.5, (a * 2 + b + c) * 0.25, nearest.point};
    points[i] = scale.out(places[i % std::size(places)]);
  }
}

// Runs a query of limited work. Returns its units.
std::uint64_t units_of(query::ProbeState& probe, Wait wait, const Vec3& point,
                       const Arguments& arguments) {
  const query::ModelGeometry& model = probe.model().geometry;
  query::PageAccessor accessor(probe.reader(), wait);
  octree::TraversalStats work;
  const QueryOptions options{.parts = arguments.part == "all" ? kAllParts : kDistance,
                             .wait = Wait::kNever,
                             .max_work = arguments.max_work};
  const query::QueryContext context{model, accessor.pages(), probe.coherence(), work};
  if (arguments.part == "side") {
    query::find_containment(context, point, model.scale.in(point), {}, options);
  } else {
    ClosestPoint answer = query::unanswered(Status::kExact);
    query::closest_point(context, point, options, answer);
  }
  return work.units;
}

int run(const Arguments& arguments) {
  const auto model = query::ModelState::open(
      arguments.model, {.memory_budget_bytes = std::uint64_t{8} << 30, .max_probes = 1},
      {.starts_fetching = false});
  if (!model) return std::cerr << "work_bench: " << model.error().text << '\n', 1;
  auto reader = (*model)->claim_reader();
  if (!reader) return std::cerr << "work_bench: " << reader.error().text << '\n', 1;
  const auto probe = query::ProbeState::create((*model)->serving(), std::move(*reader));
  probe->coherence().is_on = false;
  auto points = points_in((*model)->info(), arguments.queries);
  const query::ModelGeometry& geometry = (*model)->geometry();
  if (arguments.at == "surface") move_to(geometry.tree, *probe, points);
  if (arguments.at == "caps" && geometry.tree.caps) move_to(geometry.caps, *probe, points);
  for (const Vec3& point : points) units_of(*probe, Wait::kForPages, point, arguments);
  std::uint64_t most = 0;
  for (const Vec3& point : points) {
    CALLGRIND_ZERO_STATS;
    CALLGRIND_START_INSTRUMENTATION;
    const std::uint64_t units = units_of(*probe, Wait::kNever, point, arguments);
    CALLGRIND_STOP_INSTRUMENTATION;
    CALLGRIND_DUMP_STATS_AT(std::to_string(units).c_str());
    most = std::max(most, units);
  }
  fmt::print("{}\n", most);
  return most <= arguments.max_work ? 0 : 1;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Arguments arguments;
  CLI::App app("Units of work of real-time queries, run by ./dev work-units");
  app.add_option("model", arguments.model, "File that planetree build wrote")->required();
  app.add_option("--part", arguments.part, "distance, side or all")
      ->check(CLI::IsMember({"distance", "side", "all"}))
      ->capture_default_str();
  app.add_option("--at", arguments.at, "Where the points are: box, surface or caps")
      ->check(CLI::IsMember({"box", "surface", "caps"}))
      ->capture_default_str();
  app.add_option("--queries", arguments.queries, "How many")->capture_default_str();
  app.add_option("--max-work", arguments.max_work, "Limit of each query")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(arguments);
}
