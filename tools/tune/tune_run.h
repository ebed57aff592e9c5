#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "tools/cli/progress.h"
#include "tools/trace_file/trace_header.h"
#include "tools/tune/felt_sessions.h"
#include "tools/tune/lookup_export.h"
#include "tools/tune/memory_search.h"
#include "tools/tune/page_size_replay.h"
#include "tools/tune/trace_analysis.h"
#include "tools/tune/tune_arguments.h"
#include "tools/tune/tune_record.h"

namespace planetree::tools {

/// Reads traces and measures all that a TuneRecord has.
class TuneRun {
 public:
  TuneRun(const TuneArguments& arguments, Progress& progress)
      : arguments_(arguments), progress_(progress) {}

  /// What failed, and the file that it concerns.
  struct Failure {
    std::string file;
    Error error;
  };
  using Outcome = std::optional<Failure>;  ///< nothing: it succeeded

  /// Reads the traces. They must be of one model.
  Outcome read();
  /// Computes the curves; replays sessions if there is a model and motions.
  Outcome measure();

  const TuneRecord& record() const { return record_; }
  /// The lookups of all traces, if they are to be exported.
  const LookupExport& lookups() const { return lookups_; }

 private:
  Outcome read_trace(const std::filesystem::path& path);
  Outcome open_sessions();
  Outcome replay_page_sizes();
  void compute_curves();
  Outcome replay_sessions();
  Result<std::vector<std::vector<FeltTick>>> measure_goal(std::uint64_t bytes,
                                                          EvictionPolicy policy);
  void describe_felt(const MemorySearch& search, EvictionPolicy policy);
  std::filesystem::path model_path() const;
  Outcome fail_of_model(const Error& error) const { return Failure{model_path().string(), error}; }
  bool counts_misses() const {
    return arguments_.goal && arguments_.goal->quantity == TuneGoal::Quantity::kMisses;
  }

  const TuneArguments& arguments_;
  Progress& progress_;
  std::vector<TraceHeader> headers_;
  std::vector<TraceAnalysis> analyses_;
  LookupExport lookups_;
  std::unique_ptr<FeltSessions> sessions_;  // null without a model
  TuneRecord record_;
};

}  // namespace planetree::tools
