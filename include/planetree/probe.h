#pragma once

#include <memory>
#include <span>

#include "planetree/error.h"
#include "planetree/model.h"
#include "planetree/types.h"

namespace planetree {

namespace query {
class ProbeState;
}

/// Queries a Model. One per thread: not for two threads at once.
///
/// No ask allocates, throws or prints. An ask reads the pages it misses from
/// the file and may wait for the disk; one of Wait::kNever does not: it calls
/// nothing of the system, takes no lock and visits at most QueryOptions::max_work nodes
/// and blocks, or what 4096 of them take.
class Probe {
 public:
  /// errors  kBadArgument when OpenOptions::max_probes are there already.
  [[nodiscard]] static Result<Probe> create(const Model& model);

  Probe(Probe&&) noexcept;
  Probe& operator=(Probe&&) noexcept;
  ~Probe();

  /// Nearest surface point to `query`, model units; its side and contact normal.
  ///
  /// With the default QueryOptions the answer is exact unless pages are unreadable or a wall
  /// of a region is nearer (ModelInfo::has_region). An exact one is a function of
  /// the file and the query alone: the same bits for any thread, memory budget,
  /// order of asking and processor.
  /// A query or limit that is NaN, infinite (but max_distance) or negative
  /// (limits) gives kBadQuery.
  ClosestPoint closest_point(Vec3 query, const QueryOptions& options = {}) noexcept;

  /// Which side of the surface `query` is on: exactly, however near it is. (Only
  /// coordinates below 2^-1022 of the model's size are rounded.) Of the QueryOptions,
  /// `wait` and `max_work` count. Of a model that is not watertight, the side by its
  /// winding number; unknown only where the work ends before that is certain to
  /// be above or below 1/2, or where it is 1/2 to some 2^-45 a triangle, or where
  /// a region tells no side.
  Containment contains(Vec3 query, const QueryOptions& options = {}) noexcept;

  /// Says where the probe is and how fast it goes, model units a second: pages that asks of
  /// Wait::kNever will need on the way are got ahead of time, as far as there are others to
  /// evict. A hint: no answer depends on it but through what is resident. Costs a few stores.
  void motion(Vec3 position, Vec3 velocity) noexcept;

  /// One answer per query, the same bits as one by one, asked in an order that
  /// turns pages seldom, by OpenOptions::batch_threads threads. With Wait::kNever
  /// by the caller's alone, and by what is resident then. The spans are
  /// equally long and do not overlap; until the call returns, anything may be in
  /// the answers'. More than one thread are oneTBB's, which may allocate.
  void closest_points(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                      const QueryOptions& options = {}) noexcept;
  void contains(std::span<const Vec3> queries, std::span<Containment> answers,
                const QueryOptions& options = {}) noexcept;

 private:
  explicit Probe(std::unique_ptr<query::ProbeState> state) noexcept;
  std::unique_ptr<query::ProbeState> state_;
};

}  // namespace planetree
