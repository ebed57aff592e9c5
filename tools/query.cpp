#include "tools/query.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/cli/open_model.h"
#include "tools/cli/progress.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand_options.h"
#include "tools/points/point_reader.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kChunkPoints = 65536;
constexpr std::uint64_t kMaxWaitMs = std::uint64_t{24} * 60 * 60 * 1000;

/// Counts of answers by status and by side.
struct Tally {
  std::uint64_t points = 0;
  std::array<std::uint64_t, kStatusCount> by_status{};
  std::array<std::uint64_t, kSideCount> by_side{};

  template <class Answer>
  void add(std::span<const Answer> answers) {
    points += answers.size();
    for (const Answer& answer : answers) {
      ++by_status[static_cast<std::size_t>(answer.status)];
      ++by_side[static_cast<std::size_t>(answer.side)];
    }
  }
};

class QueryRun {
 public:
  QueryRun(const QueryArguments& arguments, Console& console, const Model& model, Probe& probe)
      : arguments_(arguments), console_(console), model_(model), probe_(probe) {}

  int run(PointReader& points) {
    const int status =
        arguments_.contains ? answer_all<Containment>(points) : answer_all<ClosestPoint>(points);
    const auto error = pages_lost(model_.stats());
    return error ? std::max(status, console_.fail(arguments_.file.string(), *error)) : status;
  }

  std::string json_report(double seconds) const {
    const Stats stats = model_.stats();
    nlohmann::ordered_json report = {{"points", tally_.points}};
    for (std::size_t i = 0; i < kStatusCount; ++i)
      report[std::string(status_word(static_cast<Status>(i)))] = tally_.by_status[i];
    for (std::size_t i = 0; i < kSideCount; ++i)
      report["sides"][std::string(side_word(static_cast<Side>(i)))] = tally_.by_side[i];
    report["seconds"] = seconds;
    report["points_per_second"] = static_cast<double>(tally_.points) / std::max(seconds, 1e-9);
    report["pages_read"] = stats.pages_read;
    report["quarantined_pages"] = stats.quarantined_pages;
    report["waits_given_up"] = stats.waits_given_up;
    report["budget_bytes"] = stats.budget_bytes;
    report["peak_resident_bytes"] = peak_resident_bytes();
    return json_line(report);
  }

 private:
  void run(std::span<const Vec3> queries, std::span<ClosestPoint> answers) {
    probe_.closest_points(queries, answers, arguments_.options);
  }
  void run(std::span<const Vec3> queries, std::span<Containment> answers) {
    probe_.contains(queries, answers, arguments_.options);
  }

  template <class Answer>
  int answer_all(PointReader& points) {
    AnswerWriter writer(console_, arguments_.format);
    // No progress bar where rows go to a terminal, because they would overwrite each other.
    Progress progress(arguments_.quiet || console_.output_is_terminal(), arguments_.json);
    progress.start("answering", 0, "points");
    std::vector<Vec3> queries(kChunkPoints);
    std::vector<Answer> answers(kChunkPoints);
    bool wanted = writer.begin(Answer());
    while (wanted) {
      const auto count = points.read(queries);
      if (!count) {
        progress.finish();
        return console_.fail(points.name(), count.error());
      }
      if (*count == 0) break;
      const auto batch_queries = std::span(queries).first(*count);
      const auto batch_answers = std::span(answers).first(*count);
      run(batch_queries, batch_answers);
      tally_.add<Answer>(batch_answers);
      wanted = writer.write(batch_queries, std::span<const Answer>(batch_answers));
      progress.add(*count);
    }
    return kDone;
  }

  const QueryArguments& arguments_;
  Console& console_;
  const Model& model_;
  Probe& probe_;
  Tally tally_;
};

Result<void> check_output(const QueryArguments& arguments, const Console& console) {
  if (arguments.format != AnswerFormat::kF64 || !console.output_is_terminal()) return {};
  return make_error(
      ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
      "a terminal cannot show raw numbers; redirect standard output, or omit --format f64");
}

}  // namespace

int run_query(const QueryArguments& arguments, Console& console) {
  if (const auto checked = check_output(arguments, console); !checked)
    return console.fail("standard output", checked.error());
  const std::string file = arguments.file.string();
  const auto model = open_model(arguments.file, arguments.memory_bytes, console,
                                static_cast<unsigned>(arguments.threads),
                                static_cast<unsigned>(arguments.wait_limit_ms));
  if (!model) return console.fail(file, model.error());
  auto probe = Probe::create(*model);
  if (!probe) return console.fail(file, probe.error());
  const auto points = open_points(arguments.points.string(), console.input());
  if (!points) return console.fail(points_name(arguments.points.string()), points.error());

  const auto started = std::chrono::steady_clock::now();
  QueryRun query_run(arguments, console, *model, *probe);
  const int status = query_run.run(**points);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - started;
  if (arguments.json) console.note(query_run.json_report(elapsed.count()));
  return console.finish(status);
}

void add_query(CLI::App& app, Console& console, std::function<int()>& action) {
  static const std::map<std::string, AnswerFormat> formats = {{"csv", AnswerFormat::kCsv},
                                                              {"jsonl", AnswerFormat::kJsonLines},
                                                              {"f64", AnswerFormat::kF64}};
  const auto options = std::make_shared<QueryArguments>();
  SubcommandOptions subcommand(app, "query",
                               "Find the nearest surface point and the side of each point");
  subcommand.require(
      subcommand.path("file", "FILE", options->file, "File that planetree build wrote"));
  subcommand.default_text(
      subcommand.path("points", "POINTS", options->points,
                      "Query points, in model units: CSV (x,y,z; other columns are ignored; a "
                      "header may name the columns), PLY (its vertices) or .f64 (raw little-endian "
                      "float64 triples); - is CSV from standard input"),
      "-");
  subcommand.flag("--contains", options->contains, "Report only the side of each point");
  subcommand.default_text(
      subcommand.length("--max-error", options->options.max_error, false,
                        "Tolerance of the distance, in model units: the search may stop once the "
                        "interval is this narrow; 0 means exact"),
      "0");
  subcommand.default_text(subcommand.length("--max-distance", options->options.max_distance, true,
                                            "Search no farther than this, in model units"),
                          "inf");
  subcommand.default_text(
      subcommand.bytes("--memory", options->memory_bytes, "Maximum memory for the model"), "256M");
  subcommand.default_text(
      subcommand.count(
          "--threads", options->threads, OpenOptions::kMaxBatchThreads,
          "Number of threads; 0 means one for each processor. Answers do not depend on it"),
      "0");
  subcommand.default_text(
      subcommand.count("--wait-limit", options->wait_limit_ms, kMaxWaitMs,
                       "Longest wait for one page, in milliseconds. After it the answer is "
                       "degraded, with an interval that holds; other answers are not affected"),
      "10000");
  subcommand.default_text(
      subcommand.word(
          "--format", {"csv", "jsonl", "f64"},
          [options](const std::string& name) { options->format = formats.at(name); },
          "csv: a header and a row for each point; jsonl: an object for each point, with null for "
          "numbers that are not finite; f64: 14 little-endian float64 for each point (x y z "
          "distance lower upper side px py pz nx ny nz triangle; side is -1 inside, 0 on the "
          "surface, 1 outside; NaN means an unknown side or no triangle), with --contains 4 (x y z "
          "side)"),
      "csv");
  subcommand.flag("--json", options->json,
                  "Report at the end as one JSON object, the last line on standard error; progress "
                  "as JSON lines there too");
  subcommand.flag("--quiet", options->quiet, "Show no progress");
  subcommand.on_given([options, &console, &action] {
    action = [options, &console] { return run_query(*options, console); };
    return std::string();
  });
}

}  // namespace planetree::tools
