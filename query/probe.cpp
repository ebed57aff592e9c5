#include "planetree/probe.h"

#include <new>
#include <utility>

#include "query/answer/closest_point.h"
#include "query/answer/containment.h"
#include "query/probe_state.h"
#include "query/serve/batch.h"
#include "query/serve/fp_environment.h"

namespace planetree {
namespace {

// Apart from what most asks come to, which needs few registers.
[[gnu::noinline]] Containment contains_computed(query::ProbeState& probe, const Vec3& query,
                                                const QueryOptions& options) noexcept {
  const query::FpEnvironmentGuard host;
  return query::contains(probe, query, options);
}

}  // namespace

Result<Probe> Probe::create(const Model& model) {
  auto reader = model.state_->claim_reader();
  if (!reader) return reader.error();
  std::unique_ptr<query::BatchBuffers> storage(new (std::nothrow) query::BatchBuffers);
  if (!storage)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for a probe; free some and try again");
  return Probe(query::ProbeState::create(*model.state_, std::move(*reader), std::move(storage)));
}

Probe::Probe(std::unique_ptr<query::ProbeState> state) noexcept : state_(std::move(state)) {}
Probe::Probe(Probe&&) noexcept = default;
Probe& Probe::operator=(Probe&&) noexcept = default;
Probe::~Probe() = default;

ClosestPoint Probe::closest_point(Vec3 query, const QueryOptions& options) noexcept {
  const query::FpEnvironmentGuard host;
  return query::closest_point(*state_, query, options);
}

Containment Probe::contains(Vec3 query, const QueryOptions& options) noexcept {
  // Before the register is read, which waits for what the thread computes.
  const Containment fast = query::contains_fast(*state_, query, options);
  return fast.side != Side::kUnknown ? fast : contains_computed(*state_, query, options);
}

void Probe::motion(Vec3 position, Vec3 velocity) noexcept {
  state_->fetch_requests().motion.give({position, velocity, state_->last_parts()});
}

void Probe::contains(std::span<const Vec3> queries, std::span<Containment> answers,
                     const QueryOptions& options) noexcept {
  const query::FpEnvironmentGuard host;
  query::contains(*state_, queries, answers, options);
}

void Probe::closest_points(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                           const QueryOptions& options) noexcept {
  const query::FpEnvironmentGuard host;
  query::closest_points(*state_, queries, answers, options);
}

}  // namespace planetree
