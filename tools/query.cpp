#include "tools/query.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/answer_tally.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/open_model.h"
#include "tools/cli/progress.h"
#include "tools/points/point_reader.h"
#include "tools/session/session_trace.h"
#include "tools/simulation/trace_budget.h"
#include "tools/trace_file/trace_writer.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kChunkPoints = 65536;
// With a trace: so few that the lookups of one chunk find room in it, and the trace can be drained
// in between.
constexpr std::size_t kTracedPoints = 16384;
constexpr std::uint32_t kTraceWords = std::uint32_t{1} << 20;
constexpr std::size_t kChunkOfSets = 256;  // points of which each may have many rows

/// No progress bar where rows go to a terminal, because they would overwrite each other.
bool shows_rows(const QueryArguments& arguments, const Console& console) {
  return arguments.output == "-" && console.output_is_terminal();
}

/// The trace file of a run of queries, and what drains the page trace to it.
class QueryTrace {
 public:
  /// Opens the file, if the arguments name one.
  static Result<std::unique_ptr<QueryTrace>> create(const QueryArguments& arguments) {
    if (arguments.trace.empty()) return std::unique_ptr<QueryTrace>();
    auto writer = TraceWriter::create(arguments.trace, arguments.force);
    if (!writer) return writer.error();
    return std::unique_ptr<QueryTrace>(new QueryTrace(std::move(*writer)));
  }
  Result<void> begin(const Model& model, const QueryArguments& arguments) {
    TraceHeader header =
        trace_header_of(model, arguments.file, arguments.memory_bytes, arguments.policy);
    header.fetch_threads = static_cast<std::uint16_t>(OpenOptions().fetch_threads);
    recorder_.emplace(model, writer_);
    return writer_.begin(header);
  }
  void drain() { recorder_->drain(); }
  Result<void> finish() { return recorder_->finish(0); }

 private:
  explicit QueryTrace(TraceWriter writer) : writer_(std::move(writer)) {}

  TraceWriter writer_;
  std::optional<TraceRecorder> recorder_;
};

/// Answers points. Its time begins with it, because the first points may come late.
class QueryRun {
 public:
  /// trace  records the queries; null: nothing does
  QueryRun(const QueryArguments& arguments, Console& console, const Model& model, Probe& probe,
           QueryTrace* trace)
      : arguments_(arguments),
        console_(console),
        model_(model),
        probe_(probe),
        trace_(trace),
        options_(arguments.options),
        form_(arguments.form),
        progress_(arguments.quiet || shows_rows(arguments, console), arguments.json) {
    if (!arguments.parts_are_given && !form_.signed_distance)
      form_.parts = options_.parts &= parts_told(model, options_.side_rule);
    progress_.start("answering", 0, "points");
  }

  int run(PointReader& points, AnswerOutput& output) {
    const int status = answer(points, output);
    const auto error = pages_lost(model_.stats());
    if (error) return std::max(status, console_.fail(arguments_.file.string(), *error));
    return status;
  }

  std::string json_report() const {
    const Stats stats = model_.stats();
    nlohmann::ordered_json report = tally_.json(seconds());
    report["pages_read"] = stats.pages_read;
    report["quarantined_pages"] = stats.quarantined_pages;
    report["waits_given_up"] = stats.waits_given_up;
    report["budget_bytes"] = arguments_.memory_bytes;  // without the trace
    report["peak_resident_bytes"] = peak_resident_bytes();
    return json_line(report);
  }

 private:
  // Points and their answers, one a row.
  template <class Answer>
  struct Rows {
    std::span<const Vec3> points;
    std::span<const Answer> answers;
  };

  int answer(PointReader& points, AnswerOutput& output) {
    if (arguments_.contains) {
      std::vector<Containment> answers(chunk_points());
      return answer_all<Containment>(points, output, [&](std::span<const Vec3> queries) {
        const auto own = std::span(answers).first(queries.size());
        probe_.contains(queries, own, options_);
        return Rows<Containment>{queries, own};
      });
    }
    if (arguments_.triangles.is_given()) {
      TriangleRows sets(probe_, options_, arguments_.triangles);
      return answer_all<ClosestPoint>(points, output, [&](std::span<const Vec3> queries) {
        sets.answer(queries);
        return Rows<ClosestPoint>{sets.points(), sets.rows()};
      });
    }
    std::vector<ClosestPoint> answers(chunk_points());
    return answer_all<ClosestPoint>(points, output, [&](std::span<const Vec3> queries) {
      const auto own = std::span(answers).first(queries.size());
      probe_.closest_points(queries, own, options_);
      return Rows<ClosestPoint>{queries, own};
    });
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }

  std::size_t chunk_points() const {
    return arguments_.triangles.is_given() ? kChunkOfSets : trace_ ? kTracedPoints : kChunkPoints;
  }

  // rows_of(queries) returns Rows.
  template <class Answer, class RowsOf>
  int answer_all(PointReader& points, AnswerOutput& output, const RowsOf& rows_of) {
    AnswerWriter writer(output, form_);
    std::vector<Vec3> queries(chunk_points());
    Result<bool> wanted = true;
    while (wanted && *wanted) {
      const auto count = points.read(queries);
      if (!count || (*count == 0 && tally_.points == 0)) {
        progress_.finish();
        return console_.fail(points.name(), count ? no_point() : count.error());
      }
      if (*count == 0) break;
      const Rows<Answer> rows = rows_of(std::span<const Vec3>(queries).first(*count));
      if (trace_) trace_->drain();
      if (tally_.points == 0) wanted = writer.begin(Answer());
      tally_.add(*count, rows.answers);
      if (wanted && *wanted) wanted = writer.write(rows.points, rows.answers);
      progress_.add(*count);
    }
    return finish(output, wanted);
  }

  static Error no_point() {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "it has no point; give at least one, as a line x,y,z");
  }

  int finish(AnswerOutput& output, const Result<bool>& wanted) {
    const auto written = wanted ? output.commit() : Result<void>(wanted.error());
    if (written && *wanted)
      progress_.finish(tally_.text(seconds()));
    else
      progress_.finish();
    return written ? kDone : console_.fail(arguments_.output.string(), written.error());
  }

  const QueryArguments& arguments_;
  Console& console_;
  const Model& model_;
  Probe& probe_;
  QueryTrace* const trace_;
  QueryOptions options_;
  AnswerForm form_;
  Progress progress_;
  AnswerTally tally_;
  std::chrono::steady_clock::time_point started_ = std::chrono::steady_clock::now();
};

/// The output must neither be an input, nor be shown as raw numbers.
Result<void> check_output(const QueryArguments& arguments, const Console& console) {
  namespace fs = std::filesystem;
  if (arguments.output != "-") {
    std::error_code none;
    for (const fs::path& input : {arguments.file, arguments.points})
      if (input != "-" && fs::equivalent(input, arguments.output, none))
        return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                          "this is an input itself; name another output");
    return {};
  }
  if (arguments.form.format != AnswerFormat::kF64 || !console.output_is_terminal()) return {};
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "a terminal cannot show raw numbers; use --output, or omit --format f64");
}

Result<OpenOptions> open_options(const QueryArguments& arguments) {
  OpenOptions options;
  options.memory_budget_bytes = arguments.memory_bytes;
  options.layers = arguments.layers;
  options.policy = arguments.policy;
  options.batch_threads = batch_threads_of(static_cast<unsigned>(arguments.threads));
  options.wait_limit_ms = static_cast<unsigned>(arguments.wait_limit_ms);
  options.use_io_uring = !arguments.no_io_uring;
  options.max_probes = 1;
  if (arguments.trace.empty()) return options;
  options.page_trace_capacity = kTraceWords;
  const auto budget = budget_with_trace(arguments.file, options);
  if (!budget) return budget.error();
  options.memory_budget_bytes = *budget;
  return options;
}

int finish_trace(QueryTrace& trace, const QueryArguments& arguments, const Model& model,
                 Console& console) {
  const std::string name = arguments.trace.string();
  if (const auto written = trace.finish(); !written) return console.fail(name, written.error());
  if (const std::uint64_t dropped = model.stats().page_trace_dropped; dropped > 0)
    console.warn(name, std::to_string(dropped) + " records found no room and are missing");
  return kDone;
}

std::string output_name(const QueryArguments& arguments) {
  return arguments.output == "-" ? "standard output" : arguments.output.string();
}

}  // namespace

int run_query(const QueryArguments& arguments, Console& console) {
  if (const auto checked = check_output(arguments, console); !checked)
    return console.fail(output_name(arguments), checked.error());
  const std::string file = arguments.file.string();
  auto trace = QueryTrace::create(arguments);
  if (!trace) return console.fail(arguments.trace.string(), trace.error());
  const auto options = open_options(arguments);
  if (!options) return console.fail(file, options.error());
  const auto model = open_model(arguments.file, *options, console);
  if (!model) return console.fail(file, model.error());
  auto probe = Probe::create(*model);
  if (!probe) return console.fail(file, probe.error());
  if (*trace)
    if (const auto begun = (*trace)->begin(*model, arguments); !begun)
      return console.fail(arguments.trace.string(), begun.error());
  QueryRun query_run(arguments, console, *model, *probe, trace->get());
  const auto points = open_points(arguments.points.string(), console.input(), arguments.columns);
  if (!points) return console.fail(points_name(arguments.points.string()), points.error());
  auto output = AnswerOutput::open(arguments.output, arguments.force, console);
  if (!output) return console.fail(output_name(arguments), output.error());

  int status = query_run.run(**points, *output);
  if (*trace && status == kDone) status = finish_trace(**trace, arguments, *model, console);
  if (arguments.json) console.note(query_run.json_report());
  return console.finish(status);
}

}  // namespace planetree::tools
