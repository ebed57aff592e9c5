#include "query/batch.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "octree/octcode.h"
#include "query/batch_crew.h"
#include "query/closest_point.h"
#include "query/containment.h"

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

// As many queries as are put in order together, and where their answers go.
template <class Answer>
struct Window {
  const BatchOrder& order;
  std::span<const Vec3> queries;
  std::span<Answer> answers;
  const Ask& ask;
  Answer (*answer)(ProbeState&, const Vec3&, const Ask&) noexcept;

  void run(ProbeState& probe, std::size_t first, std::size_t end) const noexcept {
    for (std::size_t i = first; i < end; ++i) {
      const std::size_t at = order.query(i);
      answers[at] = answer(probe, queries[at], ask);
    }
  }
  static void run_piece(const void* window, ProbeState& probe, std::size_t first,
                        std::size_t end) noexcept {
    static_cast<const Window*>(window)->run(probe, first, end);
  }
};

// Asks every query, in an order that turns pages seldom.
template <class Answer>
void ask_in_order(ProbeState& probe, std::span<const Vec3> queries, std::span<Answer> answers,
                  const Ask& ask,
                  Answer (*answer)(ProbeState&, const Vec3&, const Ask&) noexcept) noexcept {
  assert(queries.size() == answers.size());
  // Crews take locks and wait for each other.
  BatchCrew* const crew = ask.wait == Wait::kNever ? nullptr : probe.model().crew();
  BatchOrder& order = *probe.batch_order();
  while (!queries.empty()) {
    const std::size_t count = std::min(queries.size(), BatchOrder::kMost);
    order.sort(count, [&](std::size_t i) { return place(probe.model(), queries[i]); });
    const Window<Answer> window{order, queries.first(count), answers.first(count), ask, answer};
    if (!crew || !crew->run(&window, count, &Window<Answer>::run_piece))
      window.run(probe, 0, count);
    queries = queries.subspan(count);
    answers = answers.subspan(count);
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
