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
#include "tools/answers/painted_point.h"
#include "tools/answers/ray_rows.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/open_model.h"
#include "tools/cli/progress.h"
#include "tools/points/row_reader.h"
#include "tools/query_trace.h"
#include "tools/simulation/trace_budget.h"

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

/// Answers points, rays or sweeps. Its time begins with it, because the first ones may come late.
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
        progress_(arguments.quiet || shows_rows(arguments, console), arguments.json),
        tally_(shape_of(arguments.kind)) {
    if (!arguments.parts_are_given && !form_.signed_distance)
      form_.parts = options_.parts &= parts_told(model, options_.side_rule);
    progress_.start("answering", 0, tally_.noun());
  }

  /// Answers all rows. Completes the output and the trace, and reports.
  template <class Query>
  int run(RowReader<Query>& queries, AnswerOutput& output) {
    form_.shows_range = queries.numbers() > shape_of(arguments_.kind).required;
    int status = answer(queries, output);
    const auto error = pages_lost(model_);
    if (error) status = std::max(status, console_.fail(arguments_.file.string(), *error));
    if (trace_ && status == kDone) status = trace_->finish(arguments_, model_, console_);
    if (arguments_.json) console_.note(json_report());
    return status;
  }

 private:
  // Queries and their answers, one a row.
  template <class Answer, class Query = Vec3>
  struct Rows {
    std::span<const Query> queries;
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
      return answer_points(points, output, [&](std::span<const Vec3> queries) {
        sets.answer(queries);
        return Rows<ClosestPoint>{sets.points(), sets.rows()};
      });
    }
    std::vector<ClosestPoint> answers(chunk_points());
    return answer_points(points, output, [&](std::span<const Vec3> queries) {
      const auto own = std::span(answers).first(queries.size());
      probe_.closest_points(queries, own, options_);
      return Rows<ClosestPoint>{queries, own};
    });
  }
  // rows_of(queries) returns Rows of ClosestPoint.
  template <class RowsOf>
  int answer_points(PointReader& points, AnswerOutput& output, const RowsOf& rows_of) {
    if (!arguments_.attributes) return answer_all<ClosestPoint>(points, output, rows_of);
    form_.attributes = model_.info().attributes;
    form_.value_kind = model_.info().value_kind;
    std::vector<PaintedPoint> all;
    return answer_all<PaintedPoint>(points, output, [&](std::span<const Vec3> queries) {
      const Rows<ClosestPoint> rows = rows_of(queries);
      all = painted(model_, rows.answers);
      return Rows<PaintedPoint>{rows.queries, all};
    });
  }

  int answer(RayReader& rays, AnswerOutput& output) {
    RayRows rows(probe_, options_, arguments_.hits);
    return answer_all<RayHit>(rays, output, [&](std::span<const Ray> queries) {
      rows.answer(queries);
      return Rows<RayHit, Ray>{rows.rays(), rows.rows()};
    });
  }
  int answer(SweepReader& sweeps, AnswerOutput& output) {
    std::vector<FirstContact> answers(chunk_points());
    return answer_all<FirstContact>(sweeps, output, [&](std::span<const Sweep> queries) {
      const auto own = std::span(answers).first(queries.size());
      probe_.first_contacts(queries, own, options_);
      return Rows<FirstContact, Sweep>{queries, own};
    });
  }

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - started_).count();
  }

  std::size_t chunk_points() const {
    if (arguments_.hits > 1)
      return std::clamp<std::size_t>(kChunkPoints / arguments_.hits, 1, kChunkOfSets);
    return arguments_.triangles.is_given() ? kChunkOfSets : trace_ ? kTracedPoints : kChunkPoints;
  }

  // rows_of(queries) returns Rows.
  template <class Answer, class Query, class RowsOf>
  int answer_all(RowReader<Query>& reader, AnswerOutput& output, const RowsOf& rows_of) {
    AnswerWriter writer(output, form_);
    std::vector<Query> queries(chunk_points());
    Result<bool> wanted = true;
    while (wanted && *wanted) {
      const auto count = reader.read(queries);
      if (!count || (*count == 0 && tally_.queries() == 0)) {
        progress_.finish();
        return console_.fail(reader.name(), count ? no_row() : count.error());
      }
      if (*count == 0) break;
      const auto rows = rows_of(std::span<const Query>(queries).first(*count));
      if (trace_) trace_->drain();
      if (tally_.queries() == 0) wanted = writer.begin(Answer());
      tally_.add(*count, rows.answers);
      if (wanted && *wanted) wanted = writer.write(rows.queries, rows.answers);
      progress_.add(*count);
    }
    if (wanted && *wanted) wanted = writer.finish();
    return finish(output, wanted);
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

  Error no_row() const {
    const RowShape& shape = shape_of(arguments_.kind);
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "it has no %s; give at least one, as a line %s", shape.noun,
                      shape.joined_names().c_str());
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

/// The output must neither be an input, nor be shown as raw bytes.
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
  const AnswerFormat format = arguments.form.format;
  const char* const raw = format == AnswerFormat::kF64   ? "f64"
                          : format == AnswerFormat::kPly ? "ply"
                          : format == AnswerFormat::kVtp ? "vtp"
                                                         : nullptr;
  if (raw == nullptr || !console.output_is_terminal()) return {};
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "a terminal cannot show raw numbers; use --output, or omit --format %s", raw);
}

/// A NumPy array is begun before its number of rows is known, and completed at its front.
Result<void> check_can_rewrite(const QueryArguments& arguments, const AnswerOutput& output) {
  if (arguments.form.format != AnswerFormat::kNpy || output.can_rewrite()) return {};
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "a NumPy array has its number of rows in front, which a pipe or a device "
                    "cannot be told at the end; name a file by --output, or use --format f64");
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
  arguments.source.apply_to(options);
  if (arguments.trace.empty()) return options;
  options.page_trace_capacity = kTraceWords;
  const auto budget = budget_with_trace(arguments.file, options);
  if (!budget) return budget.error();
  options.memory_budget_bytes = *budget;
  return options;
}

/// Attributes that answers show.
constexpr std::uint32_t kShown = kKeepColor | kKeepUv | kKeepValue;

Error keeps_nothing() {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                    "the file keeps no attributes; build it with --keep color, uv or value");
}

std::string output_name(const QueryArguments& arguments) {
  return arguments.output == "-" ? "standard output" : arguments.output.string();
}

/// Opens the queries and the output, and answers.
template <class Open>
int answer_rows(QueryRun& query_run, const QueryArguments& arguments, Console& console,
                const Open& open) {
  const std::string name = arguments.points.string();
  const auto queries = open(name, console.input(), arguments.columns);
  if (!queries) return console.fail(points_name(name), queries.error());
  auto output = AnswerOutput::open(arguments.output, arguments.force, console);
  if (!output) return console.fail(output_name(arguments), output.error());
  if (const auto checked = check_can_rewrite(arguments, *output); !checked)
    return console.fail(output_name(arguments), checked.error());
  return query_run.run(**queries, *output);
}

int answer_kind(QueryRun& query_run, const QueryArguments& arguments, Console& console) {
  switch (arguments.kind) {
    case RowKind::kPoint:
      return answer_rows(query_run, arguments, console, open_points);
    case RowKind::kRay:
      return answer_rows(query_run, arguments, console, open_rays);
    case RowKind::kSweep:
      break;
  }
  return answer_rows(query_run, arguments, console, open_sweeps);
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
  if (arguments.attributes && (model->info().attributes & kShown) == 0)
    return console.fail(file, keeps_nothing());
  auto probe = Probe::create(*model);
  if (!probe) return console.fail(file, probe.error());
  if (*trace)
    if (const auto begun = (*trace)->begin(*model, arguments); !begun)
      return console.fail(arguments.trace.string(), begun.error());
  QueryRun query_run(arguments, console, *model, *probe, trace->get());
  return console.finish(answer_kind(query_run, arguments, console));
}

}  // namespace planetree::tools
