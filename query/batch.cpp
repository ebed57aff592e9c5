#include "query/batch.h"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>

#include "octree/geometry/octcode.h"
#include "query/serve/batch_threads.h"

namespace planetree::query {
namespace {

// A place on the Morton curve over the model's box and as much around it;
// neighbours there share pages. Only the order of asking depends on it.
std::uint64_t curve_key(const ModelGeometry& model, const Vec3& query) {
  const octree::TreeInfo& tree = model.tree;
  const octree::Point from = (model.scale.in(query)-tree.centre) * 0.25;
  const auto coordinate = [](double value) {
    constexpr double kCells = 1 << octree::kLevels;
    const double cell = (value + 0.5) * kCells;
    if (!(cell > 0)) return std::uint32_t{0};
    return static_cast<std::uint32_t>(std::min(cell, kCells - 1));
  };
  return octree::morton_code(coordinate(from.x()), coordinate(from.y()), coordinate(from.z()));
}

// Queries for all cache lines of an object. Inline, for gcc 12 drops calls of what does nothing
// else.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T& object) noexcept {
  constexpr std::size_t kLineBytes = 64;
  const auto* const bytes = reinterpret_cast<const std::byte*>(&object);
  for (std::size_t at = 0; at < sizeof(T); at += kLineBytes) __builtin_prefetch(bytes + at);
  __builtin_prefetch(bytes + sizeof(T) - 1);
}

// As many queries as are put in order together, and where their answers go.
template <class Answer>
struct Window {
  const BatchOrder& order;
  std::span<const Vec3> queries;
  std::span<Answer> answers;
  const QueryOptions& options;
  const ServingModel& model;

  void run(ProbeState& probe, std::size_t first, std::size_t end) const noexcept {
    constexpr std::size_t kAhead = 2;  // asks
    probe.coherence().nearest.follow(octree::CoherenceCache::Course::kCurve);
    for (std::size_t i = first; i < end; ++i) {
      // In order of the curve, queries and answers are anywhere in memory.
      if (i + kAhead < end) {
        prefetch(queries[order.query(i + kAhead)]);
        prefetch(answers[order.query(i + kAhead)]);
      }
      const std::size_t at = order.query(i);
      // What was there may have been keys.
      ::new (static_cast<void*>(&answers[at])) Answer(answer(probe, queries[at]));
    }
    probe.coherence().nearest.follow(octree::CoherenceCache::Course::kPath);
  }
  static void run_piece(const void* window, std::size_t thread, std::size_t first,
                        std::size_t end) noexcept {
    const auto& self = *static_cast<const Window*>(window);
    self.run(*self.model.batch_probes[thread], first, end);
  }

 private:
  Answer answer(ProbeState& probe, const Vec3& query) const noexcept {
    if constexpr (std::is_same_v<Answer, ClosestPoint>)
      return probe.closest_point(query, options);
    else
      return probe.contains(query, options);
  }
};

// How many keys find room in an answer's memory; 0 where sides are asked.
template <class Answer>
constexpr std::size_t kKeysPerAnswer = sizeof(Answer) / sizeof(std::uint64_t);

// How many of a batch's first queries are put in order together: as many as the probe has room for,
// or more, whose keys the last answers' memory takes. Those are asked once the others are answered.
template <class Answer>
std::size_t window_size(std::size_t count) {
  if (count <= BatchBuffers::kMax) return count;
  if (kKeysPerAnswer<Answer> == 0) return BatchBuffers::kMax;
  return std::max(BatchBuffers::kMax, count - (count / (kKeysPerAnswer<Answer> + 1) + 1));
}

// Memory of answers for keys instead, until new ones are made there.
template <class Answer>
std::span<std::uint64_t> keys_in(std::span<Answer> answers, std::size_t count) {
  static_assert(std::is_trivially_destructible_v<Answer>);
  static_assert(alignof(Answer) >= alignof(std::uint64_t));
  assert(answers.size_bytes() >= count * sizeof(std::uint64_t));
  void* const memory = answers.data();
  auto* const keys = static_cast<std::uint64_t*>(memory);
  std::uninitialized_default_construct_n(keys, count);
  return {keys, count};
}

// For the first `count` of the queries of these answers.
template <class Answer>
std::span<std::uint64_t> keys_for(BatchBuffers& storage, std::span<Answer> answers,
                                  std::size_t count) {
  if constexpr (kKeysPerAnswer<Answer> != 0)
    if (count > BatchBuffers::kMax) return keys_in(answers.subspan(count), count);
  return std::span(storage.keys).first(count);
}

// Queries every query, in an order that turns pages seldom.
template <class Answer>
void query_in_order(ProbeState& probe, std::span<const Vec3> queries, std::span<Answer> answers,
                    const QueryOptions& options) noexcept {
  assert(queries.size() == answers.size());
  // Crews take locks and wait for each other.
  BatchThreads* const batch_threads =
      options.wait == Wait::kNever ? nullptr : probe.model().batch_threads;
  while (!queries.empty()) {
    const std::size_t count = window_size<Answer>(queries.size());
    BatchOrder order(keys_for(*probe.batch_buffers(), answers, count));
    order.sort(probe.batch_buffers()->sorter,
               [&](std::size_t i) { return curve_key(probe.model().geometry, queries[i]); });
    const Window<Answer> window{order, queries.first(count), answers.first(count), options,
                                probe.model()};
    if (!batch_threads || !batch_threads->run(&window, count, &Window<Answer>::run_piece))
      window.run(probe, 0, count);
    queries = queries.subspan(count);
    answers = answers.subspan(count);
  }
}

}  // namespace

void closest_points(ProbeState& probe, std::span<const Vec3> queries,
                    std::span<ClosestPoint> answers, const QueryOptions& options) noexcept {
  query_in_order(probe, queries, answers, options);
}

void contains(ProbeState& probe, std::span<const Vec3> queries, std::span<Containment> answers,
              const QueryOptions& options) noexcept {
  query_in_order(probe, queries, answers, options);
}

}  // namespace planetree::query
