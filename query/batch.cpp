#include "query/probe_state.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <type_traits>

#include "octree/geometry/octcode.h"
#include "query/batch_prefetch.h"
#include "query/serve/batch_threads.h"

namespace planetree::query {
namespace {

// Returns the position of a query on the Morton curve of a cube around the model. Queries near each
// other on the curve share pages. Only the order of the queries depends on it.
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

// Returns the point by which a query takes its place on the curve.
const Vec3& place_of(const Vec3& query) { return query; }
const Vec3& place_of(const Ray& ray) { return ray.origin; }
const Vec3& place_of(const Sweep& sweep) { return sweep.from; }

// Without regard to overflow: only the order of the queries depends on it.
double distance_between(const Vec3& a, const Vec3& b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y) +
                   (a.z - b.z) * (a.z - b.z));
}

// Prefetches all cache lines of an object. Always inlined, because gcc 12 drops calls of a function
// that only prefetches.
template <class T>
[[gnu::always_inline]] inline void prefetch(const T& object) noexcept {
  constexpr std::size_t kLineBytes = 64;
  const auto* const bytes = reinterpret_cast<const std::byte*>(&object);
  for (std::size_t at = 0; at < sizeof(T); at += kLineBytes) __builtin_prefetch(bytes + at);
  __builtin_prefetch(bytes + sizeof(T) - 1);
}

// The queries of a batch that are sorted together, and their answers.
//
// answer_of  answer_of(probe, query) returns the answer of one of `queries`
// options    of the queries
template <class Query, class Answer, class AnswerOf>
struct Window {
  const BatchOrder& order;
  std::span<const Query> queries;
  std::span<Answer> answers;
  const AnswerOf& answer_of;
  const ServingModel& model;
  const QueryOptions& options;

  void run(ProbeState& probe, std::size_t first, std::size_t end) const noexcept {
    if constexpr (std::is_same_v<Query, Vec3>)
      if (BatchPrefetch::helps(probe, options)) return run_remote(probe, first, end);
    run_all(probe, first, end);
  }
  void run_remote(ProbeState& probe, std::size_t first, std::size_t end) const noexcept {
    BatchPrefetch ahead(probe, queries, order, options, BatchPrefetch::pages_each(end - first));
    probe.set_looks_ahead(false);
    while (first < end) {
      const std::size_t stop = std::min(first + BatchPrefetch::kQueries, end);
      ahead.run(first, stop);
      run_all(probe, first, stop);
      first = stop;
    }
    probe.set_looks_ahead(true);
  }
  void run_all(ProbeState& probe, std::size_t first, std::size_t end) const noexcept {
    constexpr std::size_t kAhead = 2;  // queries
    probe.coherence().nearest.follow(octree::CoherenceCache::Course::kCurve);
    probe.set_in_batch(true);
    for (std::size_t i = first; i < end; ++i) {
      // In the order of the curve, queries and answers are scattered in memory.
      if (i + kAhead < end) {
        prefetch(queries[order.query(i + kAhead)]);
        prefetch(answers[order.query(i + kAhead)]);
      }
      const std::size_t at = order.query(i);
      // The memory may have held keys.
      ::new (static_cast<void*>(&answers[at])) Answer(answer_of(probe, queries[at]));
    }
    probe.set_in_batch(false);
    probe.coherence().nearest.follow(octree::CoherenceCache::Course::kPath);
  }
  static void run_piece(const void* window, std::size_t thread, std::size_t first,
                        std::size_t end) noexcept {
    const auto& self = *static_cast<const Window*>(window);
    self.run(*self.model.batch_probes[thread], first, end);
  }
};

// Number of keys that fit into the memory of an answer; 0 for containment.
template <class Answer>
constexpr std::size_t kKeysPerAnswer = sizeof(Answer) / sizeof(std::uint64_t);

// Returns how many of a batch's first queries are sorted together: as many as the probe has keys
// for, or more if the memory of the last answers holds the keys. The queries of those answers run
// later, in other windows.
template <class Answer>
std::size_t window_size(std::size_t count) {
  if (count <= BatchBuffers::kMax) return count;
  if (kKeysPerAnswer<Answer> == 0) return BatchBuffers::kMax;
  return std::max(BatchBuffers::kMax, count - (count / (kKeysPerAnswer<Answer> + 1) + 1));
}

// Turns the memory of answers into keys, until new answers are constructed there.
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

// Returns the keys of the first `count` queries: in `storage`, or in the memory of later answers.
template <class Answer>
std::span<std::uint64_t> keys_for(BatchBuffers& storage, std::span<Answer> answers,
                                  std::size_t count) {
  if constexpr (kKeysPerAnswer<Answer> != 0)
    if (count > BatchBuffers::kMax) return keys_in(answers.subspan(count), count);
  return std::span(storage.keys).first(count);
}

// Runs all queries, in an order that switches pages seldom: the caller's, if it does.
template <class Query, class Answer, class AnswerOf>
void query_in_order(ProbeState& probe, std::span<const Query> queries, std::span<Answer> answers,
                    const QueryOptions& options, const AnswerOf& answer_of) noexcept {
  assert(queries.size() == answers.size());
  using Pieces = Window<Query, Answer, AnswerOf>;
  const auto run = [&](const BatchOrder& order, std::size_t count) {
    const Pieces window{order,     queries.first(count), answers.first(count),
                        answer_of, probe.model(),        options};
    // BatchThreads take locks and wait for each other. Real-time queries must not.
    BatchThreads* const threads =
        options.wait == Wait::kNever ? nullptr : probe.model().batch_threads;
    if (!threads || !threads->run(&window, count, &Pieces::run_piece)) window.run(probe, 0, count);
    queries = queries.subspan(count);
    answers = answers.subspan(count);
  };
  const auto gap = [&](std::size_t i, std::size_t k) {
    return distance_between(place_of(queries[i]), place_of(queries[k]));
  };
  if (BatchOrder::is_in_order(queries.size(), gap)) return run(BatchOrder(), queries.size());
  while (!queries.empty()) {
    const std::size_t count = window_size<Answer>(queries.size());
    BatchOrder order(keys_for(*probe.batch_buffers(), answers, count));
    order.sort(probe.batch_buffers()->sorter, [&](std::size_t i) {
      return curve_key(probe.model().geometry, place_of(queries[i]));
    });
    run(order, count);
  }
}

// Runs queries for sets, each with its share of `answers`.
//
// find  find(probe, query, room) returns what a query found
template <class Find>
void find_in_order(ProbeState& probe, std::span<const Vec3> queries,
                   std::span<ClosestPoint> answers, std::span<Found> found,
                   const QueryOptions& options, const Find& find) noexcept {
  if (queries.empty()) return;
  assert(answers.size() % queries.size() == 0);
  const std::size_t share = answers.size() / queries.size();
  query_in_order(probe, queries, found, options, [&](ProbeState& own, const Vec3& query) noexcept {
    const auto at = static_cast<std::size_t>(&query - queries.data());
    return find(own, query, answers.subspan(at * share, share));
  });
}

}  // namespace

void closest_points(ProbeState& probe, std::span<const Vec3> queries,
                    std::span<ClosestPoint> answers, const QueryOptions& options) noexcept {
  query_in_order(probe, queries, answers, options,
                 [&options](ProbeState& own, const Vec3& query) noexcept {
                   return own.closest_point(query, options);
                 });
}

void contains(ProbeState& probe, std::span<const Vec3> queries, std::span<Containment> answers,
              const QueryOptions& options) noexcept {
  QueryOptions of_sides = options;
  of_sides.parts = kSide;
  query_in_order(probe, queries, answers, of_sides,
                 [&options](ProbeState& own, const Vec3& query) noexcept {
                   return own.contains(query, options);
                 });
}

void find_triangles(ProbeState& probe, std::span<const Vec3> queries, double radius, bool wants_all,
                    std::span<ClosestPoint> answers, std::span<Found> found,
                    const QueryOptions& options) noexcept {
  find_in_order(
      probe, queries, answers, found, options,
      [&](ProbeState& own, const Vec3& query, std::span<ClosestPoint> room) noexcept {
        return own.find_triangles(TriangleSetQuery{query, radius, wants_all}, room, options);
      });
}

void find_contacts(ProbeState& probe, std::span<const Vec3> queries, double radius,
                   std::span<ClosestPoint> answers, std::span<Found> found,
                   const QueryOptions& options) noexcept {
  find_in_order(probe, queries, answers, found, options,
                [&](ProbeState& own, const Vec3& query, std::span<ClosestPoint> room) noexcept {
                  return own.find_contacts(query, radius, room, options);
                });
}

void first_hits(ProbeState& probe, std::span<const Ray> rays, std::span<RayHit> hits,
                const QueryOptions& options) noexcept {
  query_in_order(probe, rays, hits, options, [&options](ProbeState& own, const Ray& ray) noexcept {
    return own.first_hit(ray, options);
  });
}

void first_contacts(ProbeState& probe, std::span<const Sweep> sweeps,
                    std::span<FirstContact> contacts, const QueryOptions& options) noexcept {
  query_in_order(probe, sweeps, contacts, options,
                 [&options](ProbeState& own, const Sweep& sweep) noexcept {
                   return own.first_contact(sweep, options);
                 });
}

}  // namespace planetree::query
