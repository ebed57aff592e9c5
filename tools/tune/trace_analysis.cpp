#include "tools/tune/trace_analysis.h"

#include <algorithm>

namespace planetree::tools {
namespace {

bool is_of_a_program(PageAccess::Query kind) {
  return kind == PageAccess::Query::kClosestPoint || kind == PageAccess::Query::kContains;
}

}  // namespace

bool is_counted_lookup(const PageAccess& access) noexcept {
  using Event = PageAccess::Event;
  if (!is_of_a_program(access.query_kind)) return false;
  switch (access.event) {
    case Event::kHit:
    case Event::kPrefetched:
    case Event::kFetched:
      return true;
    case Event::kMissed:
    case Event::kLate:
      return access.needed;
    default:
      return false;
  }
}

void TraceAnalysis::add(const PageAccess& access) {
  using Event = PageAccess::Event;
  end_ns_ = std::max(end_ns_, access.time_ns);
  prefetch_.add(access);
  timeline_.add(access);
  switch (access.event) {
    case Event::kInstalled:
      if (access.is_upper) references_.set_upper(access.page);
      return;
    case Event::kEvicted:
    case Event::kEvictedUnused:
      ++evictions_;
      return;
    case Event::kMotion:
      motions_[access.probe].push_back({access.time_ns, access.position, access.velocity});
      return;
    case Event::kDegraded:
      degraded_ += is_of_a_program(access.query_kind);
      begin_queries(access);
      return;
    default:
      add_lookup(access);
  }
}

void TraceAnalysis::add_lookup(const PageAccess& access) {
  if (access.query_kind == PageAccess::Query::kOpen) {
    references_.add(access.page);
    return;
  }
  begin_queries(access);
  if (is_counted_lookup(access)) references_.add(access.page);
}

/// Queries without a lookup have no record. Their numbers are left out.
void TraceAnalysis::begin_queries(const PageAccess& access) {
  if (!is_of_a_program(access.query_kind)) return;
  if (!is_open_) {
    references_.end_opening();
    is_open_ = true;
  }
  std::uint64_t& next = next_query_[access.probe];
  for (; next <= access.query; ++next) {
    references_.begin_query();
    ++queries_;
  }
}

const std::vector<RecordedMotion>& TraceAnalysis::motions() const {
  static const std::vector<RecordedMotion> none;
  const auto most = std::max_element(
      motions_.begin(), motions_.end(),
      [](const auto& one, const auto& other) { return one.second.size() < other.second.size(); });
  return most == motions_.end() ? none : most->second;
}

}  // namespace planetree::tools
