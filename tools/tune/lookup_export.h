#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "planetree/error.h"
#include "planetree/trace.h"

namespace planetree::tools {

/// The page lookups of queries as a trace for public simulators of caches. It has the lookups that
/// TraceAnalysis counts, without those of the root, which is pinned. So a simulator's cache of one
/// page less has the misses of a number of frames. All pages have the size of a decoded page.
class LookupExport {
 public:
  enum class Format : std::uint8_t {
    kCsv,            ///< lines time_s,page,bytes below a header
    kOracleGeneral,  ///< records of 24 bytes, see write()
  };

  /// Adds a record of a trace; see TraceAnalysis::add().
  void add(const PageAccess& access);
  std::size_t size() const { return lookups_.size(); }

  /// Passes the trace to `sink` in pieces. A record of kOracleGeneral, as libCacheSim reads it, has
  /// in little-endian order: u32 seconds, u64 page, u32 bytes, i64 number of the next lookup of the
  /// same page, or -1.
  Result<void> write(Format format, std::uint64_t page_bytes,
                     const std::function<Result<void>(std::span<const std::byte>)>& sink) const;

 private:
  struct Lookup {
    std::uint32_t seconds, microseconds;
    std::uint32_t page;
  };
  std::vector<Lookup> lookups_;
};

}  // namespace planetree::tools
