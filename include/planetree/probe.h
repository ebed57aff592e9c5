#pragma once

#include <memory>
#include <span>

#include "planetree/error.h"
#include "planetree/export.h"
#include "planetree/model.h"
#include "planetree/types.h"

namespace planetree {

namespace query {
class ProbeState;
}

/// One thread's access to a Model. Holds what a query can reuse from the queries before it.
///
/// No query throws, prints or, but for batches on several threads, allocates. A blocking query
/// (Wait::kForPages) reads missing pages from the file and may wait for the disk. A real-time query
/// (Wait::kNever) makes no system call, takes no lock, faults no page of locked memory in and
/// visits at most QueryOptions::max_work records, 4096 by default.
///
/// The model must outlive the probe. Floating-point modes of the calling thread do not matter: each
/// call sets those that it needs and restores the thread's.
///
/// threads  one at a time. Different probes are independent.
class PLANETREE_API Probe {
 public:
  /// Makes a probe of a model. Allocates: not for real-time threads.
  ///
  /// errors   kBadArgument where OpenOptions::max_probes probes exist; kNoMemory.
  /// threads  any.
  [[nodiscard]] static Result<Probe> create(const Model& model);

  /// Takes over another probe, which may then only be assigned to or destroyed.
  Probe(Probe&&) noexcept;
  /// Destroys this probe and takes over another one.
  Probe& operator=(Probe&&) noexcept;
  /// Leaves the probe's index to later probes.
  ~Probe();

  /// Returns the surface point nearest to `query`, the side of `query` and the contact normal.
  ///
  /// With default options the answer is exact unless pages are unreadable or do not come within
  /// OpenOptions::wait_limit_ms, or a wall of a region is nearer than the surface (see
  /// ModelInfo::has_region). An exact answer is a function of the file and the query alone: it has
  /// the same bits for any thread, memory budget, order of queries and processor.
  ///
  /// query    model units. A coordinate that is NaN or infinite gives kBadQuery.
  /// options  a value out of range gives kBadQuery.
  ClosestPoint closest_point(Vec3 query, const QueryOptions& options = {}) noexcept;

  /// Returns the side of `query`. The side is exact at any distance from the surface; only
  /// coordinates below 2^-1022 of the model's size are rounded.
  ///
  /// The side is unknown where pages or work are missing to find it and where the file of a region
  /// does not determine it (see ModelInfo::has_region). On a model that is not watertight it is
  /// also unknown where the winding number is 1/2 or -1/2 to within about 2^-45 a triangle.
  ///
  /// query    model units. A coordinate that is NaN or infinite gives kBadQuery.
  /// options  only `wait` and `max_work` have an effect; any value out of range gives kBadQuery.
  Containment contains(Vec3 query, const QueryOptions& options = {}) noexcept;

  /// Reports position and velocity of the probe, so that fetch threads read pages that real-time
  /// queries will need on the way before they are needed. A hint: answers depend on it only
  /// through what is resident. Costs a few stores.
  ///
  /// position  model units.
  /// velocity  model units a second; 0 stops prefetching.
  void motion(Vec3 position, Vec3 velocity) noexcept;

  /// Answers a batch: each answer has the bits that closest_point() gives. Queries run in an order
  /// that minimises page switches, on OpenOptions::batch_threads threads. Those are oneTBB's, which
  /// may allocate if there is more than one. With Wait::kNever the caller's thread does all the
  /// work, and an answer depends on what is resident when its turn comes.
  ///
  /// queries  model units.
  /// answers  answers[i] is that of queries[i]. As long as `queries`, must not overlap it, and is
  ///          used as scratch memory until the call returns.
  void closest_points(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                      const QueryOptions& options = {}) noexcept;
  /// Answers a batch of contains(), under the rules of closest_points().
  void contains(std::span<const Vec3> queries, std::span<Containment> answers,
                const QueryOptions& options = {}) noexcept;

 private:
  explicit Probe(std::unique_ptr<query::ProbeState> state) noexcept;
  std::unique_ptr<query::ProbeState> state_;
};

}  // namespace planetree
