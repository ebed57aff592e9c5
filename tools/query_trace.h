#pragma once

#include <memory>
#include <optional>

#include "planetree/model.h"
#include "tools/cli/subcommand.h"
#include "tools/query.h"
#include "tools/session/session_trace.h"
#include "tools/trace_file/trace_writer.h"

namespace planetree::tools {

/// The trace file of a run of queries, and what drains the page trace to it.
class QueryTrace {
 public:
  /// Opens the file. Null if the arguments name none.
  static Result<std::unique_ptr<QueryTrace>> create(const QueryArguments& arguments);

  Result<void> begin(const Model& model, const QueryArguments& arguments);
  void drain() { recorder_->drain(); }
  /// Completes the file. Reports errors and lost records; returns the exit status.
  int finish(const QueryArguments& arguments, const Model& model, Console& console);

 private:
  explicit QueryTrace(TraceWriter writer) : writer_(std::move(writer)) {}

  TraceWriter writer_;
  std::optional<TraceRecorder> recorder_;
};

}  // namespace planetree::tools
