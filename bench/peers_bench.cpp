// Times per ask beside Embree 3 on one mesh, both warm, on one pinned core.
// usage: peers_bench MESH MODEL.ptree [QUERIES] [ROUNDS]

#include <sched.h>

#include <cmath>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "bench/embree_peer.h"
#include "bench/rounds.h"
#include "bench/workloads.h"
#include "octree/build/mesh_reader.h"
#include "planetree/planetree.h"

namespace planetree::bench {
namespace {

class CornerList final : public octree::TriangleSink {
 public:
  Result<void> triangle(std::uint64_t, const std::array<Vec3, 3>& corners) override {
    for (const Vec3& corner : corners)
      for (const double value : {corner.x, corner.y, corner.z})
        values.push_back(static_cast<float>(value));
    return {};
  }
  void set_aside(std::uint64_t, std::uint64_t, const octree::SetAside&) override {}
  void progress(std::uint64_t, std::uint64_t) override {}

  std::vector<float> values;
};

// The last core: the first takes the system's interrupts.
void pin_to_last_core() {
  cpu_set_t allowed, chosen;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) return;
  CPU_ZERO(&chosen);
  for (int core = 0; core < CPU_SETSIZE; ++core)
    if (CPU_ISSET(core, &allowed)) {
      CPU_ZERO(&chosen);
      CPU_SET(core, &chosen);
    }
  sched_setaffinity(0, sizeof chosen, &chosen);
}

int fail(const Error& error) {
  std::cerr << "peers_bench: " << error.text << '\n';
  return 1;
}

int run(const char* mesh, const char* file, std::size_t count, std::size_t rounds) {
  CornerList corners;
  if (const auto read = octree::read_mesh(mesh, corners); !read) return fail(read.error());
  OpenOptions options;
  options.memory_budget_bytes = std::uint64_t{64} << 30;
  auto model = Model::open(file, options);
  if (!model) return fail(model.error());
  auto probe = Probe::create(*model);
  if (!probe) return fail(probe.error());
  pin_to_last_core();
  const EmbreePeer embree(corners.values);
  const ModelInfo& info = model->info();
  const double triangles = static_cast<double>(info.triangles);

  const Ask distance_alone{.parts = kDistance};
  const SurfaceOf surface = [&](const Vec3& query) {
    return probe->closest_point(query, distance_alone);
  };
  const std::vector<AskDistance> contenders = {
      [&](const Vec3& query) { return probe->closest_point(query, distance_alone).distance; },
      [&](const Vec3& query) { return embree.distance(query); },
      [&](const Vec3& query) { return probe->closest_point(query).distance; },
      [&](const Vec3& query) { return probe->contains(query).side == Side::kInside ? 1.0 : 0.0; }};
  nlohmann::json report;
  report["triangles"] = info.triangles;
  report["bytes_per_triangle"] = {
      {"planetree", static_cast<double>(model->stats().arena_bytes) / triangles},
      {"embree", static_cast<double>(embree.bytes()) / triangles}};
  fmt::print("{} triangles; {:.1f} bytes a triangle in memory, Embree {:.1f}\n", info.triangles,
             report["bytes_per_triangle"]["planetree"].get<double>(),
             report["bytes_per_triangle"]["embree"].get<double>());
  fmt::print("{:<10}{:>14}{:>14}{:>10}{:>16}{:>16}{:>14}\n", "workload", "planetree ns",
             "Embree ns", "times", "sums differ by", "all parts ns", "side ns");
  for (const Workload workload :
       {Workload::kUniform, Workload::kNear, Workload::kPath, Workload::kContact}) {
    const Box box{info.box_lower, info.box_upper};
    const std::vector<Vec3> queries = make_queries(workload, box, surface, count, 1);
    const std::vector<Timing> timings = take_turns(contenders, queries, rounds);
    const double ratio = timings[1].median_ns / timings[0].median_ns;
    const double differ = std::fabs(timings[1].checksum - timings[0].checksum) /
                          static_cast<double>(count) / box.diagonal();
    fmt::print("{:<10}{:>14.0f}{:>14.0f}{:>10.2f}{:>16.1e}{:>16.0f}{:>14.0f}\n", name_of(workload),
               timings[0].median_ns, timings[1].median_ns, ratio, differ, timings[2].median_ns,
               timings[3].median_ns);
    report["workloads"][name_of(workload)] = {{"planetree_ns", timings[0].median_ns},
                                              {"embree_ns", timings[1].median_ns},
                                              {"times_faster", ratio},
                                              {"all_parts_ns", timings[2].median_ns},
                                              {"side_ns", timings[3].median_ns}};
  }
  if (const char* path = std::getenv("PLANETREE_BENCH_JSON"))
    if (FILE* out = std::fopen(path, "w")) {
      fmt::print(out, "{}\n", report.dump(2));
      std::fclose(out);
    }
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: peers_bench MESH MODEL.ptree [QUERIES] [ROUNDS]\n";
    return 2;
  }
  const std::size_t count = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 20000;
  const std::size_t rounds = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 5;
  return planetree::bench::run(argv[1], argv[2], count, rounds);
}
