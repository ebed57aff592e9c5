#include "tools/compare/hausdorff_search.h"

#include <cmath>
#include <filesystem>
#include <system_error>

namespace planetree::tools {
namespace {

// Above the errors of a few rounded operations.
constexpr double kRoundUp = 1 + 0x1p-49;
// Above 1/sqrt(3).
constexpr double kCornerReach = 0.577350269189626;
// Rounded middles move a part by at most 2^-52 of the coordinates each time that it is split, up to
// 16 times by MeshPieceMaker and less than 64 times here.
constexpr double kMiddleError = 0x1p-45;

constexpr std::uint64_t kHeldBytes = std::uint64_t{8} << 20;
constexpr std::size_t kPieceParts = 4096, kBatchParts = 2048;
constexpr std::size_t kMaxRemembered = 32768;  // points whose near triangles are in memory

double greatest_coordinate(const std::array<Vec3, 3>& corners) {
  double greatest = 0;
  for (const Vec3& corner : corners)
    for (const double value : {corner.x, corner.y, corner.z})
      greatest = std::max(greatest, std::fabs(value));
  return greatest;
}

double slack_of(const std::array<Vec3, 3>& corners) {
  return kMiddleError * greatest_coordinate(corners);
}

double longest_edge(const std::array<Vec3, 3>& corners) {
  const auto& [a, b, c] = corners;
  return kRoundUp * std::max({distance_of(a, b), distance_of(b, c), distance_of(c, a)});
}

/// The bound by the way from the corners.
double bound_by_way(const std::array<Vec3, 3>& corners, const std::array<double, 3>& upper) {
  const auto& [a, b, c] = corners;
  const double ab = distance_of(a, b), bc = distance_of(b, c), ca = distance_of(c, a);
  const double nearest_corner =
      *std::ranges::max_element(upper) + kCornerReach * std::max({ab, bc, ca});
  return std::min({nearest_corner, upper[0] + std::max(ab, ca), upper[1] + std::max(ab, bc),
                   upper[2] + std::max(bc, ca)});
}

storage::SpillFile temporary_file() {
  std::error_code none;
  std::filesystem::path directory = std::filesystem::temp_directory_path(none);
  return {directory.empty() ? "." : directory, kHeldBytes};
}

}  // namespace

HausdorffSearch::HausdorffSearch(Probe& probe, const HausdorffGoal& goal, double max_distance)
    : probe_(probe),
      goal_(goal),
      options_{.parts = kDistance, .max_distance = max_distance},
      waiting_(temporary_file()) {}

HausdorffSearch::Part HausdorffSearch::make_part(const std::array<Corner, 3>& corners) const {
  Part part;
  part.is_certain = true;
  const double error = goal_.error_for(interval_.lower);
  for (std::size_t i = 0; i < 3; ++i) {
    part.corners[i] = corners[i].point;
    part.upper[i] = corners[i].upper;
    part.is_certain = part.is_certain && corners[i].upper - corners[i].lower <= error / 4;
  }
  part.bound = bound_by_way(part.corners, part.upper);
  const std::uint64_t triangle = corners[0].triangle;
  if (triangle != kNoTriangle && triangle == corners[1].triangle && triangle == corners[2].triangle)
    part.bound = std::min(part.bound, *std::ranges::max_element(part.upper));
  part.bound = kRoundUp * part.bound + slack_of(part.corners);
  return part;
}

bool HausdorffSearch::can_split(const Part& part) const {
  const double slack = slack_of(part.corners);
  return part.is_certain && std::isfinite(part.bound) && splits_ < goal_.max_splits &&
         longest_edge(part.corners) > 16 * slack && slack <= goal_.error_for(interval_.lower) / 4;
}

Result<void> HausdorffSearch::add(const MeshPiece& piece, std::span<const ClosestPoint> answers) {
  for (std::size_t i = 0; i < answers.size(); ++i) interval_.add(piece.corners[i], answers[i]);
  std::vector<Part> waiting;
  const auto corner = [&](std::uint32_t i) { return Corner(piece.corners[i], answers[i]); };
  for (const auto& [a, b, c] : piece.triangles) {
    const Part part = make_part({corner(a), corner(b), corner(c)});
    if (part.bound <= limit())
      retire(part);
    else
      waiting.push_back(part);
  }
  const auto appended = waiting_.append(std::as_bytes(std::span(waiting)));
  return appended ? Result<void>() : appended.error();
}

Result<void> HausdorffSearch::refine(const std::function<void(std::uint64_t)>& progress) {
  std::vector<Part> open;
  const std::uint64_t count = waiting();
  for (std::uint64_t first = 0; first < count; first += kPieceParts) {
    const std::uint64_t piece = std::min<std::uint64_t>(kPieceParts, count - first);
    open.resize(piece);
    if (const auto read =
            waiting_.read(first * sizeof(Part), std::as_writable_bytes(std::span(open)));
        !read)
      return read;
    refine_all(open);
    progress(piece);
  }
  interval_.upper = std::max(interval_.upper, upper_);
  return {};
}

// The part of the greatest bound comes first, because it is likely to raise the lower end. The list
// stays short: it has at most three parts more for each one that is being split, per level.
void HausdorffSearch::refine_all(std::vector<Part>& open) {
  std::ranges::stable_sort(open, {}, &Part::bound);
  std::vector<Part> batch;
  while (!open.empty()) {
    batch.clear();
    while (!open.empty() && batch.size() < kBatchParts) {
      Part part = open.back();
      open.pop_back();
      if (part.bound > limit() && can_split(part)) tighten(part);
      if (part.bound > limit() && can_split(part)) {
        batch.push_back(part);
        ++splits_;
      } else {
        retire(part);
      }
    }
    split(batch, open);
  }
}

const HausdorffSearch::NearTriangles& HausdorffSearch::near_triangles(const Vec3& point) {
  if (near_.size() >= kMaxRemembered) near_.clear();
  const auto [found, is_new] = near_.try_emplace(point);
  if (!is_new) return found->second;
  std::array<ClosestPoint, kNearest> answers;
  const std::size_t count = probe_.nearest_triangles(point, answers, options_).count;
  for (const ClosestPoint& answer : std::span(answers).first(count))
    if (answer.triangle != kNoTriangle) found->second.emplace_back(answer.triangle, answer.upper);
  std::ranges::sort(found->second);
  return found->second;
}

/// Bounds a part by each triangle that is near all three corners.
void HausdorffSearch::tighten(Part& part) {
  // Copies, since the next call may forget what the last one returned.
  std::array<NearTriangles, 3> near;
  for (std::size_t i = 0; i < 3; ++i) near[i] = near_triangles(part.corners[i]);
  double bound = std::numeric_limits<double>::infinity();
  for (const auto& [triangle, upper] : near[0]) {
    double greatest = upper;
    bool is_shared = true;
    for (std::size_t i = 1; i < 3 && is_shared; ++i) {
      const auto found = std::ranges::lower_bound(near[i], triangle, {}, &NearTriangle::first);
      is_shared = found != near[i].end() && found->first == triangle;
      if (is_shared) greatest = std::max(greatest, found->second);
    }
    if (is_shared) bound = std::min(bound, greatest);
  }
  part.bound = std::min(part.bound, kRoundUp * bound + slack_of(part.corners));
}

void HausdorffSearch::split(std::span<const Part> parts, std::vector<Part>& open) {
  PositionNumbers numbers;
  std::vector<Vec3> middles;
  std::vector<std::array<std::uint32_t, 3>> middles_of(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 middle = middle_of(parts[i].corners[k], parts[i].corners[(k + 1) % 3]);
      const auto [found, is_new] =
          numbers.try_emplace(middle, static_cast<std::uint32_t>(middles.size()));
      if (is_new) middles.push_back(middle);
      middles_of[i][k] = found->second;
    }
  std::vector<ClosestPoint> answers(middles.size());
  probe_.closest_points(middles, answers, options_);
  for (std::size_t i = 0; i < middles.size(); ++i) interval_.add(middles[i], answers[i]);
  const std::size_t first = open.size();
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    std::array<Corner, 3> ends, halves;
    for (std::size_t k = 0; k < 3; ++k) {
      ends[k] = Corner(part.corners[k], part.upper[k]);
      halves[k] = Corner(middles[middles_of[i][k]], answers[middles_of[i][k]]);
    }
    const auto take = [&](const std::array<Corner, 3>& corners) {
      Part made = make_part(corners);
      made.bound = std::min(made.bound, part.bound);
      open.push_back(made);
    };
    for (std::size_t k = 0; k < 3; ++k) take({ends[k], halves[k], halves[(k + 2) % 3]});
    take(halves);
  }
  std::stable_sort(open.begin() + static_cast<std::ptrdiff_t>(first), open.end(),
                   [](const Part& a, const Part& b) { return a.bound < b.bound; });
}

}  // namespace planetree::tools
