// Walks along a straight line and reports the least distance to a model's surface: a planner's
// check of a tool path.
// usage: clearance MODEL.ptree

#include <planetree/planetree.h>

#include <cstdio>

namespace {

planetree::Vec3 between(const planetree::Vec3& from, const planetree::Vec3& to, double share) {
  return {from.x + share * (to.x - from.x), from.y + share * (to.y - from.y),
          from.z + share * (to.z - from.z)};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: clearance MODEL.ptree\n");
    return 2;
  }
  planetree::OpenOptions options;
  options.memory_budget_bytes = std::uint64_t{64} << 20;
  const auto model = planetree::Model::open(argv[1], options);
  if (!model) {
    std::fprintf(stderr, "clearance: %s: %s\n", argv[1], model.error().text);
    return 1;
  }
  auto probe = planetree::Probe::create(*model);
  if (!probe) {
    std::fprintf(stderr, "clearance: %s\n", probe.error().text);
    return 1;
  }

  // Needs the distance alone, to a thousandth of the path instead of the last bit.
  const planetree::Vec3 from = model->info().box_lower;
  const planetree::Vec3 to = model->info().box_upper;
  planetree::QueryOptions query_options;
  query_options.parts = planetree::kDistance;
  query_options.max_error = 1e-3 * (to.x - from.x);

  planetree::ClosestPoint tightest;
  double where = 0;
  constexpr int kSteps = 1000;
  for (int step = 0; step <= kSteps; ++step) {
    const double share = static_cast<double>(step) / kSteps;
    const planetree::ClosestPoint nearest =
        probe->closest_point(between(from, to, share), query_options);
    if (step > 0 && nearest.lower >= tightest.lower) continue;
    tightest = nearest;
    where = share;
  }
  std::printf(
      "least clearance %.6g (certainly at least %.6g) at %.1f %% of the path,\n"
      "to triangle %llu at %.6g %.6g %.6g\n",
      tightest.distance, tightest.lower, 100 * where,
      static_cast<unsigned long long>(tightest.triangle), tightest.point.x, tightest.point.y,
      tightest.point.z);
}
