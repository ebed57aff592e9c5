#pragma once

#include <cstdint>
#include <string>

#include "planetree/eviction_policy.h"

namespace planetree::tools {

/// What a trace file says of the session before its records.
struct TraceHeader {
  std::string model;                 ///< name of the model's file, at most kMaxNameBytes
  std::uint64_t content_id[2] = {};  ///< ModelInfo::content_id
  std::uint64_t memory_bytes = 0;    ///< OpenOptions::memory_budget_bytes, without the trace
  std::uint64_t frames = 0;          ///< Stats::frames
  std::uint32_t page_bytes = 0;      ///< ModelInfo::page_bytes: memory of a page
  std::uint32_t pages = 0;           ///< ModelInfo::pages
  std::uint32_t rate_hz = 0;         ///< ticks per second; 0: the session has no ticks
  std::uint32_t layers = 0;          ///< Stats::layers
  std::uint64_t latency_ns = 0;      ///< of a simulated disk; 0: the disk was real
  std::uint16_t fetch_threads = 0;   ///< OpenOptions::fetch_threads
  EvictionPolicy policy = EvictionPolicy::kClock;
  bool is_deterministic = false;  ///< disk and clock were simulated, see latency_ns

  static constexpr std::size_t kMaxNameBytes = 4096;
};

/// What a trace file says at its end.
struct TraceTotals {
  std::uint64_t records = 0;
  std::uint64_t lost = 0;   ///< records that the traces had no room for: Stats::page_trace_dropped
  std::uint64_t ticks = 0;  ///< of the session
};

}  // namespace planetree::tools
