#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "planetree/eviction_policy.h"
#include "planetree/types.h"
#include "tools/session/session_path.h"
#include "tools/tune/trace_analysis.h"

/// Runs of the engine whose misses a replay of their lookups has to tell, to the unit.
namespace planetree::tools {

/// What answering points by queries that wait cost, without fetch threads and thus with one reader.
struct EngineRun {
  std::uint32_t frames = 0;
  std::uint64_t misses = 0;
  TraceAnalysis analysis;  ///< empty without a trace
};

/// The points of a run.
struct EngineWork {
  std::filesystem::path model;
  std::vector<Vec3> points;
  bool is_batch = false;  ///< answer them together; else each alone, and some by contains() too
};

/// The path of a motion, found by a model of its own.
std::vector<Vec3> engine_path(const std::filesystem::path& model, TouchMotion motion,
                              std::size_t ticks);

/// Answers the points with a model within a budget. A failure ends the program with a message.
EngineRun run_engine(const EngineWork& work, EvictionPolicy policy, std::uint64_t budget,
                     bool traces);

/// A run of the engine, and what the replay says of it.
struct EngineComparison {
  EvictionPolicy policy;
  std::uint64_t budget = 0;
  std::uint32_t frames = 0;
  std::uint64_t engine = 0;    ///< misses
  std::uint64_t replayed = 0;  ///< misses of the same frames
  std::uint64_t optimum = 0;   ///< misses of Belady's optimum in the same frames
};

/// Records the lookups of the points with plenty of memory. Then compares the misses of the engine
/// within `budgets` budgets, from the least that the model opens with to `most`, and with every
/// policy, with those of the replay.
std::vector<EngineComparison> compare_engine(const EngineWork& work, std::size_t budgets,
                                             std::uint64_t most);

}  // namespace planetree::tools
