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
                                                const Ask& ask) noexcept {
  const query::HostArithmetic host;
  return query::contains(probe, query, ask);
}

}  // namespace

Result<Probe> Probe::create(const Model& model) {
  auto reader = model.state_->claim_reader();
  if (!reader) return reader.error();
  std::unique_ptr<query::BatchRoom> room(new (std::nothrow) query::BatchRoom);
  if (!room)
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for a probe; free some and try again");
  return Probe(query::ProbeState::create(*model.state_, std::move(*reader), std::move(room)));
}

Probe::Probe(std::unique_ptr<query::ProbeState> state) noexcept : state_(std::move(state)) {}
Probe::Probe(Probe&&) noexcept = default;
Probe& Probe::operator=(Probe&&) noexcept = default;
Probe::~Probe() = default;

ClosestPoint Probe::closest_point(Vec3 query, const Ask& ask) noexcept {
  const query::HostArithmetic host;
  return query::closest_point(*state_, query, ask);
}

Containment Probe::contains(Vec3 query, const Ask& ask) noexcept {
  // Before the register is read, which waits for what the thread computes.
  const Containment told = query::contains_at_a_glance(*state_, query, ask);
  return told.side != Side::kUnknown ? told : contains_computed(*state_, query, ask);
}

void Probe::motion(Vec3 position, Vec3 velocity) noexcept {
  state_->wishes().motion.give({position, velocity, state_->last_parts()});
}

void Probe::contains(std::span<const Vec3> queries, std::span<Containment> answers,
                     const Ask& ask) noexcept {
  const query::HostArithmetic host;
  query::contains(*state_, queries, answers, ask);
}

void Probe::closest_points(std::span<const Vec3> queries, std::span<ClosestPoint> answers,
                           const Ask& ask) noexcept {
  const query::HostArithmetic host;
  query::closest_points(*state_, queries, answers, ask);
}

}  // namespace planetree
