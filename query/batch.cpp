#include "query/batch.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "octree/octcode.h"
#include "query/closest_point.h"

namespace planetree::query {
namespace {

// A place on the Morton curve over the model's box and as much around it;
// neighbours there share pages. Only the order of asking depends on it.
std::uint64_t place(const ModelState& model, const Vec3& query) {
  const octree::TreeFacts& tree = model.tree();
  const octree::Point from = (model.scale().in(query)-tree.centre) * 0.25;
  const auto coordinate = [](double value) {
    constexpr double kCells = 1 << octree::kLevels;
    const double cell = (value + 0.5) * kCells;
    if (!(cell > 0)) return std::uint32_t{0};
    return static_cast<std::uint32_t>(std::min(cell, kCells - 1));
  };
  return octree::morton_code(coordinate(from.x()), coordinate(from.y()), coordinate(from.z()));
}

// Asks every query, in an order that turns pages seldom.
template <class Answer>
void ask_in_order(ProbeState& probe, std::span<const Vec3> queries, std::span<Answer> answers,
                  const Ask& ask,
                  Answer (*answer)(ProbeState&, const Vec3&, const Ask&) noexcept) noexcept {
  assert(queries.size() == answers.size());
  auto& batch = probe.batch();
  for (std::size_t first = 0; first < queries.size(); first += batch.size()) {
    const std::size_t count = std::min(batch.size(), queries.size() - first);
    for (std::size_t i = 0; i < count; ++i)
      batch[i] = {place(probe.model(), queries[first + i]), static_cast<std::uint32_t>(i)};
    std::sort(batch.begin(), batch.begin() + static_cast<std::ptrdiff_t>(count),
              [](const auto& a, const auto& b) {
                return a.code < b.code || (a.code == b.code && a.index < b.index);
              });
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t at = first + batch[i].index;
      answers[at] = answer(probe, queries[at], ask);
    }
  }
}

}  // namespace

void closest_points(ProbeState& probe, std::span<const Vec3> queries,
                    std::span<ClosestPoint> answers, const Ask& ask) noexcept {
  ask_in_order(probe, queries, answers, ask, &closest_point);
}

void contains(ProbeState& probe, std::span<const Vec3> queries, std::span<Containment> answers,
              const Ask& ask) noexcept {
  ask_in_order<Containment>(probe, queries, answers, ask, &contains);
}

}  // namespace planetree::query
