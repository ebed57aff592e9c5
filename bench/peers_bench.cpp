// Times per query of planetree and its peers on one mesh, all warm, on one pinned core.

#include <sched.h>

#include <cmath>
#include <fstream>
#include <iostream>
#include <span>
#include <vector>

#include <fmt/format.h>
#include <hwy/targets.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "bench/peer.h"
#include "bench/rounds.h"
#include "bench/workloads.h"
#include "planetree/planetree.h"

namespace planetree::bench {
namespace {

struct Options {
  std::string mesh, model, json;
  std::string instructions;  // empty: the best that the processor has
  std::vector<std::string> peers{"embree", "cgal"};
  std::vector<std::string> workloads;  // empty: all
  std::size_t queries = 20000, rounds = 5;
  bool on_curve = false;  // points in the order of a Morton curve
};

// Pins to the last core, because the first one takes the system's interrupts.
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

// Restricts planetree's kernels to one instruction set; peers choose for themselves. False where
// there are no kernels for it or the processor lacks it.
bool use_only(const std::string& instructions) {
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    const std::int64_t target = left & -left;
    if (hwy::TargetName(target) != instructions) continue;
    hwy::SetSupportedTargetsForTest(target);
    return true;
  }
  return false;
}

// One contender: a part of the answer, computed by planetree or by a peer.
struct NamedContender {
  std::string who, what;  // `what`: "distance", "side", "all parts", or distances in "a batch"
  Contender contender;
};

// Converts without a branch, which would be mispredicted for every other point and take as long as
// a query.
double number(bool answer) { return static_cast<double>(static_cast<int>(answer)); }

// Finds distances in batches on one thread.
class Batch {
 public:
  explicit Batch(Probe& probe) : probe_(&probe) {}
  double operator()(std::span<const Vec3> queries) {
    answers_.resize(queries.size());
    probe_->closest_points(queries, answers_, {.parts = kDistance});
    double sum = 0;
    for (const ClosestPoint& answer : answers_) sum += answer.distance;
    return sum;
  }

 private:
  Probe* probe_;
  std::vector<ClosestPoint> answers_;
};

std::vector<NamedContender> contenders_of(Probe& probe, std::vector<BuiltPeer>& peers,
                                          bool watertight) {
  std::vector<NamedContender> all;
  all.push_back({"planetree", "distance", one_by_one([&](const Vec3& query) {
                   return probe.closest_point(query, {.parts = kDistance}).distance;
                 })});
  all.push_back({"planetree", "all parts", one_by_one([&](const Vec3& query) {
                   return probe.closest_point(query).distance;
                 })});
  all.push_back({"planetree", "side", one_by_one([&](const Vec3& query) {
                   return number(probe.contains(query).side != Side::kOutside);
                 })});
  all.push_back({"planetree", "a batch", Batch(probe)});
  for (BuiltPeer& built : peers) {
    Peer& peer = *built.peer;
    all.push_back({peer.name(), "distance",
                   one_by_one([&peer](const Vec3& query) { return peer.distance(query); })});
    if (peer.tells_sides() && watertight)
      all.push_back({peer.name(), "side", one_by_one([&peer](const Vec3& query) {
                       return number(peer.inside(query));
                     })});
  }
  return all;
}

class Comparison {
 public:
  Comparison(const Options& options, Probe& probe, const ModelInfo& info,
             std::vector<BuiltPeer>& peers)
      : options_(options),
        info_(info),
        named_contenders_(contenders_of(probe, peers, info.watertight())),
        surface_([&](const Vec3& query) { return probe.closest_point(query); }) {}

  nlohmann::json run(Workload workload) {
    const Box box{info_.box_lower, info_.box_upper};
    std::vector<Vec3> queries = make_queries(workload, box, surface_, options_.queries, 1);
    if (options_.on_curve) sort_on_curve(box, queries);
    std::vector<Contender> contenders;
    for (const NamedContender& named : named_contenders_) contenders.push_back(named.contender);
    const std::vector<Timing> timings = take_turns(contenders, queries, options_.rounds);
    nlohmann::json rows = nlohmann::json::array();
    for (std::size_t i = 0; i < named_contenders_.size(); ++i) {
      // Compares a peer with planetree's contender for the same part.
      const std::size_t ours = named_contenders_[i].what == "side" ? 2 : 0;
      const Latency latency = latency_of(named_contenders_[i].contender, queries);
      rows.push_back({{"workload", name_of(workload)},
                      {"part", named_contenders_[i].what},
                      {"of", named_contenders_[i].who},
                      {"ns", timings[i].median_ns},
                      {"times_ours", timings[i].median_ns / timings[ours].median_ns},
                      {"sum_differs", std::fabs(timings[i].checksum - timings[ours].checksum)},
                      {"p999_ns", latency.p999_ns},
                      {"max_ns", latency.max_ns}});
      print(rows.back());
    }
    return rows;
  }

 private:
  static void print(const nlohmann::json& row) {
    fmt::print("{:<10}{:<11}{:<10}{:>10.0f}{:>8.2f}{:>11.2g}{:>10.0f}{:>10.0f}\n",
               row["workload"].get<std::string>(), row["part"].get<std::string>(),
               row["of"].get<std::string>(), row["ns"].get<double>(),
               row["times_ours"].get<double>(), row["sum_differs"].get<double>(),
               row["p999_ns"].get<double>(), row["max_ns"].get<double>());
  }

  const Options& options_;
  const ModelInfo& info_;
  std::vector<NamedContender> named_contenders_;
  SurfaceOf surface_;
};

nlohmann::json describe(const Model& model, const std::vector<BuiltPeer>& peers) {
  const auto triangles = static_cast<double>(model.info().triangles);
  nlohmann::json report{{"triangles", model.info().triangles},
                        {"file_bytes", model.info().file_bytes}};
  report["bytes_per_triangle"]["planetree"] =
      static_cast<double>(model.stats().arena_bytes) / triangles;
  fmt::print("{} triangles\n{:<10}{:>6.1f} bytes a triangle\n", model.info().triangles, "planetree",
             report["bytes_per_triangle"]["planetree"].get<double>());
  for (const BuiltPeer& built : peers) {
    const double bytes = static_cast<double>(built.bytes) / triangles;
    report["bytes_per_triangle"][built.peer->name()] = bytes;
    report["build_s"][built.peer->name()] = built.build_s;
    fmt::print("{:<10}{:>6.1f} bytes a triangle, built in {:.1f} s\n", built.peer->name(), bytes,
               built.build_s);
  }
  return report;
}

bool chosen(const Options& options, Workload workload) {
  const auto& names = options.workloads;
  return names.empty() || std::find(names.begin(), names.end(), name_of(workload)) != names.end();
}

int fail(const Error& error) {
  std::cerr << "peers_bench: " << error.text << '\n';
  return 1;
}

int run(const Options& options) {
  const auto mesh = read_peer_mesh(options.mesh.c_str());
  if (!mesh) return fail(mesh.error());
  auto peers = build_peers(options.peers, *mesh);
  if (!peers) return fail(peers.error());
  const auto model = Model::open(options.model, {.memory_budget_bytes = std::uint64_t{64} << 30});
  if (!model) return fail(model.error());
  auto probe = Probe::create(*model);
  if (!probe) return fail(probe.error());
  if (!options.instructions.empty() && !use_only(options.instructions)) {
    std::cerr << "peers_bench: no kernels for '" << options.instructions << "' here\n";
    return 2;
  }
  pin_to_last_core();

  nlohmann::json report = describe(*model, *peers);
  report["rows"] = nlohmann::json::array();
  fmt::print("{:<10}{:<11}{:<10}{:>10}{:>8}{:>11}{:>10}{:>10}\n", "points", "part", "of", "ns",
             "times", "sums off", "p99.9", "max");
  Comparison comparison(options, *probe, model->info(), *peers);
  for (const Workload workload : kWorkloads)
    if (chosen(options, workload))
      for (nlohmann::json& row : comparison.run(workload)) report["rows"].push_back(std::move(row));
  if (!options.json.empty()) std::ofstream(options.json) << report.dump(2) << '\n';
  return 0;
}

}  // namespace
}  // namespace planetree::bench

int main(int argc, char** argv) {
  planetree::bench::Options options;
  CLI::App app{"Times per query of planetree and of peers that hold the mesh in memory"};
  app.add_option("mesh", options.mesh, "Mesh that the peers load")->required();
  app.add_option("model", options.model, "Its tree, by planetree build")->required();
  app.add_option("--peers", options.peers, "embree, cgal, fcl")
      ->delimiter(',')
      ->capture_default_str();
  app.add_option("--workloads", options.workloads, "uniform, near, path, contact, teleport, medial")
      ->delimiter(',');
  app.add_option("--queries", options.queries, "Points a workload")->capture_default_str();
  app.add_flag("--on-curve", options.on_curve, "Points in the order of a Morton curve");
  app.add_option("--rounds", options.rounds, "Rounds in turn; their median counts")
      ->capture_default_str();
  app.add_option("--instructions", options.instructions,
                 "Planetree's kernels for this set alone: SSE4, AVX2, AVX3 (AVX-512)");
  app.add_option("--json", options.json, "File for all figures");
  CLI11_PARSE(app, argc, argv);
  return planetree::bench::run(options);
}
