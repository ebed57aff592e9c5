#include "octree/builder/field/field_search.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "octree/geometry/error_bounds.h"
#include "octree/geometry/octcode.h"
#include "octree/geometry/strict_math.h"
#include "octree/nearest/nearest.h"

namespace planetree::octree {
namespace {

// What the search may add to the rounding of a stored point, in quanta; see kFieldUncertainty.
constexpr double kMaxSearchError = 0x1p-8;
// Units of work for one point, and for each point on average. Statues and scans take some 20. Many
// triangles in one place take one for each of them, which would outlast the rest of the build.
constexpr std::uint32_t kMaxUnits = 4096;
constexpr std::uint64_t kMaxMeanUnits = 256;

}  // namespace

FieldSearch::FieldSearch(const BuiltTrees& trees, const FieldShape& shape,
                         std::vector<FieldPoint>& points)
    : shape_(shape),
      points_(points),
      info_(trees.info(cap_info_)),
      frames_([&trees] { return TreeFrames(trees); }) {
  for (std::uint32_t k = 0; k < shape.size[2]; k += kTile)
    for (std::uint32_t j = 0; j < shape.size[1]; j += kTile)
      for (std::uint32_t i = 0; i < shape.size[0]; i += kTile)
        tiles_.push_back({morton_code(i, j, k), {i, j, k}});
  std::ranges::sort(tiles_, {}, &Tile::morton);
}

Result<void> FieldSearch::search(std::size_t tile) {
  TreeFrames& frames = frames_.local();
  const PageReader pages = frames.reader();
  const auto& first = tiles_[tile].first;
  std::array<std::uint32_t, 3> end;
  for (unsigned axis = 0; axis < 3; ++axis)
    end[axis] = std::min(first[axis] + kTile, shape_.size[axis]);
  bool fit = true;
  TraversalStats work;
  for (std::uint32_t k = first[2]; k < end[2]; ++k)
    for (std::uint32_t j = first[1]; j < end[1]; ++j)
      for (std::uint32_t i = first[0]; i < end[0]; ++i)
        fit = fit && find(shape_.lower + shape_.at(i, j, k), pages, work,
                          points_[shape_.index_of(i, j, k)]);
  const std::uint64_t units = units_.fetch_add(work.units, std::memory_order_relaxed) + work.units;
  if (!fit || units > kMaxMeanUnits * shape_.count())
    all_fit_.store(false, std::memory_order_relaxed);
  return frames.state();
}

bool FieldSearch::find(const Point& at, const PageReader& pages, TraversalStats& work,
                       FieldPoint& stored) const {
  NearestLimits limits;
  limits.max_work = kMaxUnits;
  const NearestAnswer answer = octree::nearest(info_, at, limits, pages, work);
  if (answer.status != Status::kExact) return false;
  const Point quanta = (answer.point - shape_.lower) / shape_.quantum;
  for (unsigned axis = 0; axis < 3; ++axis) {
    const double rounded = std::floor(quanta[axis] + 0.5);
    if (!(rounded >= 0 && rounded <= kMaxFieldCoordinate)) return false;
    stored[axis] = static_cast<std::uint16_t>(rounded);
  }
  // What is left of the uncertainty must cover the interval of the search, and the rounding of the
  // coordinates of grid point and surface point.
  const double largest = std::max(at.cwiseAbs().maxCoeff(), answer.point.cwiseAbs().maxCoeff());
  const double rounding = kFieldPointRounding * largest;
  return answer.upper - answer.lower + rounding <= kMaxSearchError * shape_.quantum;
}

}  // namespace planetree::octree
