// Compares the answers on real meshes with those of CGAL and brute force.
// usage: check_real FOLDER [FOLDER] [NAME...]
// NAME is a mesh without .ply; default: the meshes of kMeshes and all others in the folders. Meshes
// are searched for in the folders, then in planetree-data in the temporary directory. Exit status 1
// if any answer is wrong or a mesh is missing.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "octree/builder/tree_builder.h"
#include "octree/geometry/triangle_distance.h"
#include "planetree/planetree.h"
#include "tests/octree/builder/silent_progress.h"
#include "tests/oracle/brute_force.h"
#include "tests/oracle/cgal_oracle.h"
#include "tests/oracle/random.h"
#include "tests/oracle/winding.h"
#include "tests/soak/cgal_side.h"
#include "tests/soak/mesh_triangles.h"
#include "tests/soak/paged_answers.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::oracle {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMeshes[] = {"nefertiti_70k", "skull_100k", "lion_63k_open",
                                        "motorbike_332k_nonmanifold", "ct_air_6.6M"};
constexpr std::string_view kPagedMesh = "ct_air_6.6M";
constexpr std::size_t kQueriesPerKind = 10000;
constexpr std::size_t kTieChecks = 20;   // against every triangle
constexpr double kAllowedShare = 1e-12;  // maximum error / diagonal
constexpr std::uint64_t kLargeBudgetBytes = std::uint64_t{4} << 30;
constexpr std::uint64_t kProgramBytes = std::uint64_t{40} << 20;

double diagonal_of(const ModelInfo& info) {
  return std::hypot(info.box_upper.x - info.box_lower.x, info.box_upper.y - info.box_lower.y,
                    info.box_upper.z - info.box_lower.z);
}

// Half of the queries in the box enlarged by a tenth, half near the surface.
std::vector<Vec3> make_queries(const ModelInfo& info, const std::vector<Corners>& triangles) {
  Random random(20240601);
  const auto anywhere = [&](double low, double high) {
    return random.between(low - 0.1 * (high - low), high + 0.1 * (high - low));
  };
  std::vector<Vec3> queries;
  for (std::size_t i = 0; i < kQueriesPerKind; ++i)
    queries.push_back({anywhere(info.box_lower.x, info.box_upper.x),
                       anywhere(info.box_lower.y, info.box_upper.y),
                       anywhere(info.box_lower.z, info.box_upper.z)});
  const double off = 0.001 * diagonal_of(info);
  for (std::size_t i = 0; i < kQueriesPerKind; ++i) {
    const Corners& t = triangles[random.below(triangles.size())];
    const double v = random.unit(), w = random.unit() * (1 - v), u = 1 - v - w;
    queries.push_back({u * t[0].x + v * t[1].x + w * t[2].x + off * random.either_sign(),
                       u * t[0].y + v * t[1].y + w * t[2].y + off * random.either_sign(),
                       u * t[0].z + v * t[1].z + w * t[2].z + off * random.either_sign()});
  }
  return queries;
}

// Straight paths through the model, in steps of a twentieth of a percent of its diagonal.
std::vector<Vec3> make_path(const ModelInfo& info, const std::vector<Corners>& triangles) {
  Random random(20240602);
  const double step = 0.0005 * diagonal_of(info);
  std::vector<Vec3> path;
  while (path.size() < kQueriesPerKind) {
    const Vec3 from = triangles[random.below(triangles.size())][0];
    const Vec3 to = triangles[random.below(triangles.size())][0];
    const double length = std::hypot(to.x - from.x, to.y - from.y, to.z - from.z);
    if (!(length > 0)) continue;
    for (double along = -5 * step; along < length + 5 * step; along += step) {
      const double t = along / length;
      path.push_back({from.x + t * (to.x - from.x), from.y + t * (to.y - from.y),
                      from.z + t * (to.z - from.z)});
    }
  }
  path.resize(kQueriesPerKind);
  return path;
}

// Counts of the faults on one mesh.
struct Misses {
  std::size_t status = 0, distance = 0, interval = 0, triangle = 0, tie = 0, side = 0, paging = 0;
  double worst_share = 0;  // largest error divided by the error allowed

  [[nodiscard]] std::size_t all() const {
    return status + distance + interval + triangle + tie + side + paging;
  }
};

class MeshCheck {
 public:
  explicit MeshCheck(const fs::path& mesh) : mesh_(mesh), tree_(folder_ / "mesh.ptree") {
    octree::SilentProgress silent;
    need(octree::build_tree(mesh, tree_, {}, silent), mesh.c_str());
    triangles_ = triangles_of(mesh);
    const Model model = need(Model::open(tree_), "open");
    info_ = model.info();
    queries_ = make_queries(info_, triangles_);
    answers_ = answers_of(tree_, kLargeBudgetBytes, queries_);
  }

  void run() {
    const CgalOracle oracle(triangles_);
    thin_ = oracle.thin_count();
    for (std::size_t i = 0; i < queries_.size(); ++i) judge(i, oracle.distance(queries_[i]));
    for (std::size_t i = 0; i < kTieChecks; ++i) judge_tie(i * (queries_.size() / kTieChecks));
  }

  // Checks sides, on a path as well: of a watertight mesh with CGAL, unless CGAL does not accept it
  // as a closed mesh, and of any other with brute force.
  void run_sides() {
    const std::vector<Vec3> path = make_path(info_, triangles_);
    const std::vector<ClosestPoint> on_path = answers_of(tree_, kLargeBudgetBytes, path);
    if (info_.watertight()) {
      const CgalSide oracle(triangles_);
      if (!oracle.usable()) return;
      for (std::size_t i = 0; i < path.size(); ++i)
        misses_.side += oracle.side(path[i]) != on_path[i].side;
      for (std::size_t i = 0; i < queries_.size(); ++i)
        misses_.side += oracle.side(queries_[i]) != answers_[i].side;
    } else {
      for (std::size_t i = 0; i < path.size(); ++i) judge_open_side(path[i], on_path[i].side);
      for (std::size_t i = 0; i < queries_.size(); ++i)
        judge_open_side(queries_[i], answers_[i].side);
    }
    sides_ = path.size() + queries_.size();
  }

  // Checks that the bits are the same in little memory, and that no more memory than that is used.
  void run_paged() {
    const PagedAnswers paged = query_in_new_process(tree_, tree_.parent_path(), queries_);
    resident_bytes_ = paged.peak_resident_bytes;
    for (std::size_t i = 0; i < answers_.size(); ++i)
      misses_.paging += paged.answers.at(i) != bits_of(answers_[i]);
    misses_.paging += resident_bytes_ > kSmallBudgetBytes + kProgramBytes;
  }

  void print() const {
    std::printf("%-28s %9zu %6zu %8zu %6zu %7zu %8zu %9zu %9zu %5zu %5zu %7zu %9.2g %9.1f\n",
                mesh_.stem().c_str(), triangles_.size(), thin_, queries_.size(), sides_,
                misses_.status, misses_.distance, misses_.interval, misses_.triangle, misses_.tie,
                misses_.side, misses_.paging, misses_.worst_share,
                static_cast<double>(resident_bytes_) / (1 << 20));
    std::fflush(stdout);
  }
  [[nodiscard]] const Misses& misses() const { return misses_; }

 private:
  void judge(std::size_t i, long double truth) {
    const ClosestPoint& answer = answers_[i];
    const double allowed = kAllowedShare * diagonal_of(info_);
    const auto error = static_cast<double>(std::fabs(answer.distance - truth));
    misses_.worst_share = std::max(misses_.worst_share, error / allowed);
    misses_.status += answer.status != Status::kExact;
    misses_.distance += !(error <= allowed);
    if (answer.triangle >= triangles_.size()) {
      ++misses_.triangle;
      return;
    }
    // In long double, to the triangle with this index in the input.
    const long double own = extended_distance(queries_[i], triangles_[answer.triangle]);
    misses_.triangle += !(std::fabs(own - truth) <= allowed);
    const long double nearest = std::min(own, truth);
    misses_.interval +=
        !(answer.lower <= nearest && nearest <= answer.upper && answer.lower < answer.upper &&
          answer.distance <= answer.upper && answer.lower <= answer.distance);
  }

  // Sums over every triangle quickly, and precisely where the answer differs. Points whose winding
  // number is within a thousandth of one half are not judged.
  void judge_open_side(const Vec3& query, Side side) {
    constexpr double kMinDifference = 0.001;
    const auto certain = [](double w) { return std::fabs(std::fabs(w) - 0.5) > kMinDifference; };
    const auto of = [](double w) { return std::fabs(w) > 0.5 ? Side::kInside : Side::kOutside; };
    const double quick = quick_winding(query, triangles_);
    if (certain(quick) && side == of(quick)) return;
    const OpenWinding careful = open_winding(query, triangles_);
    const auto value = static_cast<double>(careful.value);
    if (careful.on_surface)
      misses_.side += side != Side::kOnSurface;
    else if (certain(value))
      misses_.side += side != of(value);
  }

  // Checks that the index is the least among triangles whose values have the same bits.
  void judge_tie(std::size_t i) {
    const auto point = [](const Vec3& p) { return octree::Point(p.x, p.y, p.z); };
    double least = std::numeric_limits<double>::infinity();
    std::uint64_t index = 0;
    for (std::size_t k = 0; k < triangles_.size(); ++k) {
      const Corners& t = triangles_[k];
      const double value =
          octree::triangle_value(point(queries_[i]), {point(t[0]), point(t[1]), point(t[2])})
              .squared;
      if (value >= least) continue;
      least = value;
      index = k;
    }
    misses_.tie += answers_[i].triangle != index || answers_[i].distance != std::sqrt(least);
  }

  fs::path mesh_;
  storage::TemporaryDirectory folder_;
  fs::path tree_;
  std::vector<Corners> triangles_;
  ModelInfo info_;
  std::vector<Vec3> queries_;
  std::vector<ClosestPoint> answers_;
  std::size_t thin_ = 0;
  std::size_t sides_ = 0;  // number of sides compared
  std::uint64_t resident_bytes_ = 0;
  Misses misses_;
};

fs::path find_mesh(const std::vector<fs::path>& folders, std::string_view name) {
  for (const fs::path& folder : folders) {
    fs::path path = folder / (std::string(name) + ".ply");
    if (fs::exists(path)) return path;
  }
  return {};
}

// The real meshes, whether they exist or not, and all other meshes in the folders.
std::vector<std::string> all_names(const std::vector<fs::path>& folders) {
  std::set<std::string> names(std::begin(kMeshes), std::end(kMeshes));
  for (const fs::path& folder : folders)
    if (fs::is_directory(folder))
      for (const fs::directory_entry& entry : fs::directory_iterator(folder))
        if (entry.path().extension() == ".ply") names.insert(entry.path().stem());
  return {names.begin(), names.end()};
}

enum class Verdict { kRight, kWrong, kMissing };

Verdict check_mesh(const std::vector<fs::path>& folders, std::string_view name) {
  const fs::path path = find_mesh(folders, name);
  if (path.empty()) {
    std::printf("%-28.*s missing\n", static_cast<int>(name.size()), name.data());
    return Verdict::kMissing;
  }
  MeshCheck check(path);
  check.run();
  check.run_sides();
  if (name == kPagedMesh) check.run_paged();
  check.print();
  return check.misses().all() == 0 ? Verdict::kRight : Verdict::kWrong;
}

int run(int count, char** arguments) {
  std::vector<fs::path> folders;
  std::vector<std::string> names;
  for (int i = 1; i < count; ++i) {
    if (fs::is_directory(arguments[i]))
      folders.emplace_back(arguments[i]);
    else
      names.emplace_back(arguments[i]);
  }
  if (folders.empty()) {
    std::fprintf(stderr, "usage: check_real FOLDER [FOLDER] [NAME...]\n");
    return 2;
  }
  folders.push_back(fs::temp_directory_path() / "planetree-data");
  if (names.empty()) names = all_names(folders);
  std::printf("%-28s %9s %6s %8s %6s | misses: %s\n", "mesh", "triangles", "thin", "queries",
              "sides",
              "status distance interval triangle ties sides paging; error/allowed, MiB at 32 MiB");
  int meshes[3] = {};  // by Verdict
  for (const std::string& name : names) ++meshes[static_cast<int>(check_mesh(folders, name))];
  std::printf("meshes with all answers right %d, with wrong ones %d, missing %d\n", meshes[0],
              meshes[1], meshes[2]);
  return meshes[1] + meshes[2] == 0 ? 0 : 1;
}

}  // namespace
}  // namespace planetree::oracle

int main(int count, char** arguments) {
  if (planetree::oracle::is_new_process(count, arguments))
    return planetree::oracle::run_new_process(arguments);
  return planetree::oracle::run(count, arguments);
}
