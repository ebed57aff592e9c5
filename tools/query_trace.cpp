#include "tools/query_trace.h"

#include <string>
#include <utility>

namespace planetree::tools {

Result<std::unique_ptr<QueryTrace>> QueryTrace::create(const QueryArguments& arguments) {
  if (arguments.trace.empty()) return std::unique_ptr<QueryTrace>();
  auto writer = TraceWriter::create(arguments.trace, arguments.force);
  if (!writer) return writer.error();
  return std::unique_ptr<QueryTrace>(new QueryTrace(std::move(*writer)));
}

Result<void> QueryTrace::begin(const Model& model, const QueryArguments& arguments) {
  TraceHeader header =
      trace_header_of(model, arguments.file, arguments.memory_bytes, arguments.policy);
  header.fetch_threads = static_cast<std::uint16_t>(OpenOptions().fetch_threads);
  recorder_.emplace(model, writer_);
  return writer_.begin(header);
}

int QueryTrace::finish(const QueryArguments& arguments, const Model& model, Console& console) {
  const std::string name = arguments.trace.string();
  if (const auto written = recorder_->finish(0); !written)
    return console.fail(name, written.error());
  if (const std::uint64_t dropped = model.stats().page_trace_dropped; dropped > 0)
    console.warn(name, std::to_string(dropped) + " records found no room and are missing");
  return kDone;
}

}  // namespace planetree::tools
