#include "tools/trace_file/prefetch_figures.h"

namespace planetree::tools {

void PrefetchFigures::add(const PageAccess& access) {
  using Event = PageAccess::Event;
  const bool is_demanded = access.query_kind == PageAccess::Query::kClosestPoint ||
                           access.query_kind == PageAccess::Query::kContains;
  switch (access.event) {
    case Event::kInstalled:
      read += access.query_kind == PageAccess::Query::kPrefetch;
      missing_.erase(access.page);
      break;
    case Event::kPrefetched:
      used += 1;
      break;
    case Event::kEvictedUnused:
      evicted_unused += 1;
      break;
    case Event::kLate:
      late += access.needed;
      if (access.needed) miss(access.page);
      break;
    case Event::kMissed:
      if (access.needed) miss(access.page);
      break;
    case Event::kFetched:
      if (is_demanded) miss(access.page);
      break;
    default:
      break;
  }
}

}  // namespace planetree::tools
