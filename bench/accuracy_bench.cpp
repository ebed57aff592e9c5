// Measures the errors of planetree and its peers on one mesh and the same points.
// usage: accuracy_bench MESH MODEL.ptree [QUERIES]
//
// The truth does not come from planetree: distances are computed in long double to the triangle
// that CGAL's tree finds, sides by CGAL's exact predicates.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <vector>

#include <fmt/format.h>

#include "bench/peer.h"
#include "bench/workloads.h"
#include "planetree/planetree.h"
#include "tests/oracle/cgal_oracle.h"

namespace planetree::bench {
namespace {

// Maximum error of a correct distance, as a share of the diagonal.
constexpr double kRight = 1e-12;

// `off` counts distances beyond kRight, `sides` the sides compared.
struct Verdict {
  double worst = 0;  ///< greatest error of a distance, as a share of the diagonal
  std::size_t off = 0, sides = 0, wrong_sides = 0;
};

// planetree behind the interface of the peers.
class Planetree final : public Peer {
 public:
  explicit Planetree(Probe& probe) : probe_(probe) {}
  [[nodiscard]] std::string name() const override { return "planetree"; }
  double distance(const Vec3& query) override {
    return probe_.closest_point(query, {.parts = kDistance}).distance;
  }
  bool inside(const Vec3& query) override { return probe_.contains(query).side != Side::kOutside; }

 private:
  Probe& probe_;
};

std::vector<oracle::Corners> triangles_of(const PeerMesh& mesh) {
  std::vector<oracle::Corners> triangles(mesh.triangles());
  for (std::size_t i = 0; i < mesh.corners.size(); ++i) {
    const float* const at = &mesh.positions[3 * std::size_t{mesh.corners[i]}];
    triangles[i / 3][i % 3] = {at[0], at[1], at[2]};
  }
  return triangles;
}

// Compares the answers of all peers with the truth.
class Judge {
 public:
  Judge(const PeerMesh& mesh, Peer& exact_sides, const ModelInfo& info)
      : triangles_(triangles_of(mesh)),
        distances_(triangles_),
        sides_(exact_sides),
        diagonal_(Box{info.core_lower, info.core_upper}.diagonal()),
        closed_(info.watertight()) {}

  void judge(const Vec3& query, std::span<Peer* const> peers, std::vector<Verdict>& verdicts) {
    const long double truth = distances_.distance(query);
    const bool inside = closed_ && sides_.inside(query);
    for (std::size_t i = 0; i < peers.size(); ++i) {
      const auto error = static_cast<double>(std::fabs(peers[i]->distance(query) - truth));
      verdicts[i].worst = std::max(verdicts[i].worst, error / diagonal_);
      verdicts[i].off += !(error <= kRight * diagonal_);
      if (!closed_ || !peers[i]->tells_sides()) continue;
      ++verdicts[i].sides;
      verdicts[i].wrong_sides += peers[i]->inside(query) != inside;
    }
  }

 private:
  std::vector<oracle::Corners> triangles_;
  oracle::CgalOracle distances_;
  Peer& sides_;
  double diagonal_;
  bool closed_;
};

void print(Workload workload, const Peer& peer, const Verdict& verdict) {
  const std::string sides = verdict.sides > 0 ? fmt::format("{}", verdict.wrong_sides) : "-";
  fmt::print("{:<10}{:<12}{:>18.1e}{:>14}{:>14}\n", name_of(workload), peer.name(), verdict.worst,
             verdict.off, sides);
}

int fail(const Error& error) {
  std::cerr << "accuracy_bench: " << error.text << '\n';
  return 1;
}

int run(const char* mesh_file, const char* file, std::size_t count) {
  const auto mesh = read_peer_mesh(mesh_file);
  if (!mesh) return fail(mesh.error());
  const auto model = Model::open(file, {.memory_budget_bytes = std::uint64_t{64} << 30});
  if (!model) return fail(model.error());
  auto probe = Probe::create(*model);
  if (!probe) return fail(probe.error());
  auto built = build_peers(std::vector<std::string>{"embree", "cgal"}, *mesh);
  if (!built) return fail(built.error());

  Planetree planetree(*probe);
  const std::vector<Peer*> peers{&planetree, (*built)[0].peer.get(), (*built)[1].peer.get()};
  const ModelInfo& info = model->info();
  Judge judge(*mesh, *peers[2], info);
  const SurfaceOf surface = [&](const Vec3& query) { return probe->closest_point(query); };
  fmt::print("{} triangles, {} points a workload\n", info.triangles, count);
  fmt::print("{:<10}{:<12}{:>18}{:>14}{:>14}\n", "points", "", "worst / diagonal", "distances off",
             "wrong sides");
  for (const Workload workload : {Workload::kUniform, Workload::kNear, Workload::kMedial}) {
    std::vector<Verdict> verdicts(peers.size());
    for (const Vec3& query :
         make_queries(workload, {info.core_lower, info.core_upper}, surface, count, 1))
      judge.judge(query, peers, verdicts);
    for (std::size_t i = 0; i < peers.size(); ++i) print(workload, *peers[i], verdicts[i]);
  }
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: accuracy_bench MESH MODEL.ptree [QUERIES]\n";
    return 2;
  }
  const std::size_t count = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 10000;
  return planetree::bench::run(argv[1], argv[2], count);
}
