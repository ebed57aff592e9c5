#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "planetree/eviction_policy.h"
#include "tools/trace_file/prefetch_figures.h"
#include "tools/tune/miss_curves.h"
#include "tools/tune/session_sample.h"
#include "tools/tune/trace_timeline.h"
#include "tools/tune/tune_goal.h"

namespace planetree::tools {

/// What sessions come to within a memory budget.
struct FeltPoint {
  std::uint64_t memory_bytes = 0;  ///< OpenOptions::memory_budget_bytes
  std::uint32_t frames = 0;
  FeltFigures figures;  ///< of all sessions: sums of counts, greatest of quantiles
  double value = 0;     ///< of the goal's quantity
};

/// The least memory that keeps a goal.
struct TuneRecommendation {
  TuneGoal goal;
  bool is_kept = false;  ///< false: not even with all pages in memory; the rest is then unset
  EvictionPolicy policy = EvictionPolicy::kClock;
  std::uint64_t memory_bytes = 0, low_bytes = 0, high_bytes = 0;
  std::uint32_t frames = 0;
  double value = 0;  ///< of the recorded sessions within memory_bytes
};

/// What a recorded session asked of memory in each of some page sizes.
struct PageSizeRow {
  std::uint64_t page_bytes = 0;
  std::uint32_t footprint = 0;  ///< pages
  std::uint64_t footprint_bytes = 0;
  std::vector<std::uint64_t> misses;  ///< by TuneRecord::page_size_budgets
};

/// All that `planetree tune` measures.
struct TuneRecord {
  std::vector<std::string> traces;
  std::string model;  ///< path of the model; empty if sessions were not replayed
  std::string recorded_policy;
  std::uint64_t recorded_memory_bytes = 0;
  std::uint64_t page_bytes = 0;      ///< of a decoded page
  std::uint64_t model_pages = 0;     ///< pages that queries may read
  std::uint64_t overhead_bytes = 0;  ///< budget besides the frames, as recorded
  double seconds = 0;                ///< from the first record to the last
  std::uint64_t lost = 0;            ///< records that the engine dropped

  std::uint64_t lookups = 0, queries = 0, degraded = 0;
  std::uint64_t recorded_misses = 0, evictions = 0;
  std::uint64_t compulsory = 0;
  std::uint32_t footprint = 0;  ///< frames that hold all pages looked up
  MissCurves curves;
  std::size_t knee = 0;  ///< place among the sizes, of CLOCK
  PrefetchFigures prefetch;
  TraceTimeline timeline;  ///< of the first trace

  std::uint64_t latency_ns = 0;  ///< of a page, in replayed sessions
  std::vector<FeltPoint> felt;   ///< ascending memory
  std::optional<TuneRecommendation> recommended;
  std::vector<std::uint64_t> page_size_budgets;  ///< bytes of frames
  std::vector<PageSizeRow> page_sizes;

  /// Budget with which a model has so many frames.
  std::uint64_t memory_for(std::uint32_t frames) const {
    return overhead_bytes + frames * page_bytes;
  }
  double ratio(double misses) const {
    return lookups == 0 ? 0 : misses / static_cast<double>(lookups);
  }
};

}  // namespace planetree::tools
