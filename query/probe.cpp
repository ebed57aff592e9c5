#include "planetree/probe.h"

#include <new>
#include <utility>

#include "octree/geometry/fp_environment.h"
#include "query/batch.h"
#include "query/model_state.h"
#include "query/probe_state.h"

namespace planetree {
namespace {

// Not inlined, because most calls of contains() end before it and then save few registers.
[[gnu::noinline]] Containment contains_computed(query::ProbeState& probe, const Vec3& query,
                                                const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return probe.contains(query, options);
}

}  // namespace

Result<Probe> Probe::create(const Model& model) {
  auto reader = model.state_->claim_reader();
  if (!reader) return reader.error();
  std::unique_ptr<query::BatchBuffers> storage(new (std::nothrow) query::BatchBuffers);
  if (!storage)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for a probe; free some and try again");
  return Probe(
      query::ProbeState::create(model.state_->serving(), std::move(*reader), std::move(storage)));
}

Probe::Probe(std::unique_ptr<query::ProbeState> state) noexcept : state_(std::move(state)) {}
Probe::Probe(Probe&&) noexcept = default;
Probe& Probe::operator=(Probe&&) noexcept = default;
Probe::~Probe() = default;

ClosestPoint Probe::closest_point(Vec3 query, const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  return state_->closest_point(query, options);
}

Containment Probe::contains(Vec3 query, const QueryOptions& options) noexcept {
  // Before the FpEnvironmentGuard: reading its register waits for pending computations.
  const Containment fast = state_->contains_fast(query, options);
  return fast.side != Side::kUnknown ? fast : contains_computed(*state_, query, options);
}

void Probe::motion(Vec3 position, Vec3 velocity) noexcept {
  state_->note_motion(position, velocity);
}

void Probe::contains(std::span<const Vec3> queries, std::span<Containment> answers,
                     const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  query::contains(*state_, queries, answers, options);
}

void Probe::closest_points(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                           const QueryOptions& options) noexcept {
  const octree::FpEnvironmentGuard host;
  query::closest_points(*state_, queries, answers, options);
}

}  // namespace planetree
