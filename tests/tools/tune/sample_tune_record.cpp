#include "tests/tools/tune/sample_tune_record.h"

#include "tests/tools/tune/made_accesses.h"
#include "tests/tools/tune/made_references.h"

namespace planetree::tools {

TuneRecord sample_tune_record(const std::string& trace) {
  using Event = PageAccess::Event;
  const MadeTrace made = walked_trace(20'000, 200, 3);
  const References references = references_of(made);
  TuneRecord record;
  record.traces = {trace};
  record.model = "model.ptree";
  record.recorded_policy = "clock";
  record.recorded_memory_bytes = std::uint64_t{64} << 20;
  record.page_bytes = 65536;
  record.model_pages = 1700;
  record.overhead_bytes = 3 << 20;
  record.seconds = 20;
  record.lookups = references.lookups();
  record.queries = 20'000;
  record.degraded = 60;
  record.compulsory = references.compulsory();
  record.footprint = references.footprint();
  record.curves = miss_curves(references, curve_sizes(references.footprint()));
  record.knee = knee_of(record.curves.frames, record.curves.policies[0].misses);
  record.prefetch.read = 100;
  record.prefetch.used = 70;
  record.prefetch.missed = 9;
  for (std::size_t i = 0; i < made.pages.size(); ++i) {
    const auto time_ns = i * 1'000'000;
    if (i % 50 == 0) record.timeline.add(lookup(i, made.pages[i], Event::kInstalled, time_ns));
    record.timeline.add(lookup(i, made.pages[i], Event::kHit, time_ns));
    if (i % 300 == 0) record.timeline.add(lookup(i, made.pages[i], Event::kEvicted, time_ns));
  }
  record.latency_ns = 85'000;
  for (std::uint32_t frames = 4; frames <= 256; frames *= 2) {
    FeltPoint point;
    point.frames = frames;
    point.memory_bytes = record.memory_for(frames);
    point.figures.ticks = 20'000;
    point.figures.degraded = frames == 256 ? 0 : 4000 / frames;
    point.figures.width_p99 = frames > 100 ? 0 : 1.0 / frames;
    point.figures.ticks_to_exact_p99 = 64 / frames;
    point.figures.longest_run = 128 / frames;
    record.felt.push_back(point);
  }
  TuneRecommendation recommended;
  recommended.goal = {TuneGoal::Quantity::kDegraded, 0.005};
  recommended.is_kept = true;
  recommended.memory_bytes = record.felt[4].memory_bytes;
  recommended.low_bytes = record.felt[3].memory_bytes;
  recommended.high_bytes = record.felt[5].memory_bytes;
  recommended.frames = record.felt[4].frames;
  recommended.value = 0.003;
  record.recommended = recommended;
  record.page_size_budgets = {1 << 20, 4 << 20};
  record.page_sizes = {{16384, 200, 200 * 16384, {400, 210}}, {65536, 81, 81 * 65536, {150, 90}}};
  return record;
}

}  // namespace planetree::tools
