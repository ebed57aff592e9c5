#pragma once

#include <cstdint>

#include "planetree/trace.h"

/// Records of made traces.
namespace planetree::tools {

/// A record of a query's lookup.
inline PageAccess lookup(std::uint64_t query, std::uint32_t page, PageAccess::Event event,
                         std::uint64_t time_ns = 0) {
  PageAccess access;
  access.time_ns = time_ns;
  access.query = query;
  access.page = page;
  access.octcode = page;
  access.event = event;
  access.needed = event == PageAccess::Event::kFetched;
  access.waits = access.needed;
  return access;
}

/// A record of a query of Model::open or of a fetch thread.
inline PageAccess own(PageAccess::Query kind, std::uint32_t page, PageAccess::Event event,
                      std::uint64_t time_ns = 0) {
  PageAccess access = lookup(0, page, event, time_ns);
  access.probe = 7;
  access.query_kind = kind;
  return access;
}

}  // namespace planetree::tools
