#include "tools/mesh/mesh_pieces.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/mesh_size.h"

namespace planetree::tools {
namespace {

/// Hands the triangles of a mesh reader to a maker of pieces.
class PieceSink final : public octree::TriangleSink {
 public:
  PieceSink(MeshPieceMaker& maker, const std::function<void(std::uint64_t)>& progress)
      : maker_(maker), progress_(progress) {}

  Result<void> triangle(std::uint64_t, const std::array<Vec3, 3>& corners) override {
    constexpr std::uint64_t kStep = 4096;
    if (++findings_.triangles % kStep == 0) progress_(kStep);
    return maker_.add(corners);
  }
  void skipped(std::uint64_t, std::uint64_t count, const octree::SkippedRecord& why) override {
    if (findings_.skipped == 0) findings_.first_skipped = why.text();
    findings_.skipped += count;
  }
  Result<void> progress(std::uint64_t, std::uint64_t) override { return {}; }

  MeshFindings& findings() { return findings_; }

 private:
  MeshPieceMaker& maker_;
  const std::function<void(std::uint64_t)>& progress_;
  MeshFindings findings_;
};

}  // namespace

std::size_t SamePosition::operator()(const Vec3& point) const {
  std::uint64_t hash = 0;
  for (const double value : {point.x, point.y, point.z}) {
    hash = (hash ^ std::bit_cast<std::uint64_t>(value)) * 0x9E3779B97F4A7C15;
    hash ^= hash >> 29;
  }
  return hash;
}

bool SamePosition::operator()(const Vec3& a, const Vec3& b) const {
  return std::bit_cast<std::array<std::uint64_t, 3>>(a) ==
         std::bit_cast<std::array<std::uint64_t, 3>>(b);
}

double length_of(const Vec3& vector) {
  const double greatest = std::max({std::fabs(vector.x), std::fabs(vector.y), std::fabs(vector.z)});
  if (!(greatest > 0) || std::isinf(greatest)) return greatest;
  const double x = vector.x / greatest, y = vector.y / greatest, z = vector.z / greatest;
  return greatest * std::sqrt(x * x + y * y + z * z);
}

double distance_of(const Vec3& a, const Vec3& b) {
  return length_of({a.x - b.x, a.y - b.y, a.z - b.z});
}

double area_of(const std::array<Vec3, 3>& corners, double unit) {
  const auto& [a, b, c] = corners;
  const Vec3 ab{(b.x - a.x) / unit, (b.y - a.y) / unit, (b.z - a.z) / unit};
  const Vec3 ac{(c.x - a.x) / unit, (c.y - a.y) / unit, (c.z - a.z) / unit};
  const double area =
      length_of({ab.y * ac.z - ab.z * ac.y, ab.z * ac.x - ab.x * ac.z, ab.x * ac.y - ab.y * ac.x}) /
      2;
  constexpr double kMax = 1e200;
  return area < kMax ? area : kMax;
}

MeshPieceMaker::Cuts MeshPieceMaker::modest_cuts(double spacing, std::uint64_t triangles) {
  constexpr std::uint64_t kMaxParts = std::uint64_t{1} << 22, kUnknown = std::uint64_t{1} << 16;
  Cuts cuts{spacing, 0};
  while (cuts.most < kMaxCuts &&
         (triangles == 0 ? kUnknown : triangles) <= kMaxParts >> (cuts.most + 1))
    ++cuts.most;
  return cuts;
}

MeshPieceMaker::MeshPieceMaker(const Cuts& cuts, Take take) : cuts_(cuts), take_(std::move(take)) {
  numbers_.reserve(kTriangles);
}

Result<void> MeshPieceMaker::add(const std::array<Vec3, 3>& corners) {
  struct Part {
    std::array<Vec3, 3> corners;
    int cuts = 0;
  };
  std::array<Part, kMaxCuts + 1> open;
  std::size_t count = 1;
  open[0] = {corners, 0};
  while (count > 0) {
    const Part part = open[--count];
    const auto& [a, b, c] = part.corners;
    const std::array<double, 3> edges = {distance_of(a, b), distance_of(b, c), distance_of(c, a)};
    const std::size_t longest = edges[0] >= edges[1] && edges[0] >= edges[2] ? 0
                                : edges[1] >= edges[2]                       ? 1
                                                                             : 2;
    if (!(edges[longest] > cuts_.spacing) || part.cuts == cuts_.most) {
      if (const auto added = add_whole(part.corners); !added) return added;
      continue;
    }
    const std::size_t next = (longest + 1) % 3;
    const Vec3 middle = middle_of(part.corners[longest], part.corners[next]);
    for (const std::size_t replaced : {next, longest}) {
      Part half{part.corners, part.cuts + 1};
      half.corners[replaced] = middle;
      open[count++] = half;
    }
  }
  return {};
}

Result<void> MeshPieceMaker::add_whole(const std::array<Vec3, 3>& corners) {
  std::array<std::uint32_t, 3> numbers{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [found, is_new] =
        numbers_.try_emplace(corners[i], static_cast<std::uint32_t>(piece_.corners.size()));
    if (is_new) piece_.corners.push_back(corners[i]);
    numbers[i] = found->second;
  }
  piece_.triangles.push_back(numbers);
  return piece_.triangles.size() < kTriangles ? Result<void>() : finish();
}

Result<void> MeshPieceMaker::finish() {
  if (piece_.triangles.empty()) return {};
  const auto taken = take_(piece_);
  piece_.corners.clear();
  piece_.triangles.clear();
  numbers_.clear();
  return taken;
}

Result<MeshFindings> read_mesh_pieces(const std::filesystem::path& path, std::uint64_t memory_bytes,
                                      MeshPieceMaker& maker,
                                      const std::function<void(std::uint64_t)>& progress) {
  PieceSink sink(maker, progress);
  octree::MeshScratch scratch(memory_bytes);
  auto summary = octree::read_mesh(path, sink, scratch);
  if (!summary) return summary.error();
  if (const auto finished = maker.finish(); !finished) return finished.error();
  sink.findings().notes = std::move(summary->notes);
  return std::move(sink.findings());
}

std::uint64_t estimated_triangles(const std::filesystem::path& path) {
  const auto size = octree::MeshSize::estimate(path);
  return size ? size->triangles : 0;
}

}  // namespace planetree::tools
