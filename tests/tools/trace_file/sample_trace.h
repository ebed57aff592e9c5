#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <tuple>
#include <vector>

#include "planetree/trace.h"
#include "tools/trace_file/trace_header.h"
#include "tools/trace_file/trace_reader.h"
#include "tools/trace_file/trace_writer.h"

namespace planetree::tools {

/// A short session with a record of every kind: the one of format-spec/trace-v1/samples.
inline std::vector<PageAccess> sample_records() {
  using Event = PageAccess::Event;
  using Query = PageAccess::Query;
  std::vector<PageAccess> records;
  const auto add = [&](std::uint64_t time_ns, std::uint32_t probe, std::uint64_t query, Query kind,
                       Event event, std::uint32_t page = 0) -> PageAccess& {
    PageAccess access;
    access.time_ns = time_ns;
    access.probe = probe;
    access.query = query;
    access.query_kind = kind;
    access.event = event;
    if (event != Event::kDegraded && event != Event::kMotion) {
      access.page = page;
      access.level = static_cast<std::uint8_t>(page);
      access.octcode = std::uint64_t{page} << 59 | std::uint64_t{page} * 4096;
      access.stored_bytes = 1000 * page + 7;
      access.section = page > 5 ? PageAccess::Section::kMask : PageAccess::Section::kTree;
    }
    return records.emplace_back(access);
  };
  add(3, 0, 0, Query::kOpen, Event::kFetched).waits = true;
  records.back().needed = true;
  add(1000, 0, 0, Query::kOpen, Event::kInstalled).waits = true;
  records.back().is_upper = true;
  PageAccess& motion = add(1'000'000, 0, 0, Query::kClosestPoint, Event::kMotion);
  motion.position = {1.5, -2, 0.1};
  add(1'000'000, 0, 0, Query::kClosestPoint, Event::kHit, 0);
  add(1'000'000, 0, 0, Query::kClosestPoint, Event::kMissed, 3).needed = true;
  add(1'000'000, 0, 0, Query::kClosestPoint, Event::kMissed, 4);
  add(1'000'000, 0, 0, Query::kClosestPoint, Event::kDegraded).width = 0.25F;
  add(1'085'000, 1, 0, Query::kFetch, Event::kFetched, 3).waits = true;
  add(1'170'000, 1, 0, Query::kFetch, Event::kInstalled, 3).waits = true;
  add(1'255'000, 1, 1, Query::kPrefetch, Event::kFetched, 7).waits = true;
  PageAccess& moved = add(2'000'000, 0, 1, Query::kClosestPoint, Event::kMotion);
  moved.position = {1.5, -2, 0.125};
  moved.velocity = {0, 0, (0.125 - 0.1) * 1000};
  add(2'000'000, 0, 1, Query::kClosestPoint, Event::kLate, 7).needed = true;
  add(2'340'000, 1, 1, Query::kPrefetch, Event::kEvicted, 4).waits = true;
  add(2'340'001, 1, 1, Query::kPrefetch, Event::kInstalled, 7).waits = true;
  add(3'000'000, 0, 2, Query::kContains, Event::kPrefetched, 7);
  add(3'000'000, 0, 2, Query::kContains, Event::kDegraded).width =
      std::numeric_limits<float>::infinity();
  PageAccess& batch = add(3'000'500, 2, 90'000, Query::kClosestPoint, Event::kHit, 3);
  batch.in_batch = batch.waits = true;
  add(4'000'000, 1, 2, Query::kPrefetch, Event::kEvictedUnused, 7).waits = true;
  return records;
}

inline TraceHeader sample_header() {
  TraceHeader header;
  header.model = "statue.ptree";
  header.content_id[0] = 0x0123456789abcdef;
  header.content_id[1] = 0xfedcba9876543210;
  header.memory_bytes = 4 << 20;
  header.frames = 5;
  header.page_bytes = 65536;
  header.pages = 9;
  header.rate_hz = 1000;
  header.layers = 7;
  header.latency_ns = 85'000;
  header.fetch_threads = 1;
  header.policy = EvictionPolicy::kSieve;
  header.is_deterministic = true;
  return header;
}

/// All members of a record that a file keeps.
inline auto row_of(const PageAccess& access) {
  return std::tuple(access.time_ns, access.query, access.octcode, access.probe, access.page,
                    access.stored_bytes, access.width, access.event, access.query_kind,
                    access.section, access.level, access.in_batch, access.waits, access.needed,
                    access.is_upper,
                    std::tuple(access.position.x, access.position.y, access.position.z,
                               access.velocity.x, access.velocity.y, access.velocity.z));
}

/// What reading a file gives: all records, or the error.
struct TraceContents {
  TraceHeader header;
  std::vector<PageAccess> records;
  TraceTotals totals;
  ErrorCode code = ErrorCode::kBadArgument;
  std::string error;  ///< empty: none
};

inline TraceContents read_trace(const std::string& path) {
  TraceContents contents;
  const auto fail = [&](const Error& error) {
    contents.code = error.code;
    contents.error = error.text;
    return contents;
  };
  auto reader = TraceReader::open(path);
  if (!reader) return fail(reader.error());
  contents.header = reader->header();
  std::vector<PageAccess> piece(5);
  for (;;) {
    const auto count = reader->read(piece);
    if (!count) return fail(count.error());
    if (*count == 0) break;
    contents.records.insert(contents.records.end(), piece.begin(),
                            piece.begin() + static_cast<std::ptrdiff_t>(*count));
  }
  contents.totals = reader->totals();
  return contents;
}

inline std::string file_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace planetree::tools
