#include "tools/trade.h"

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/cli/open_model.h"
#include "tools/cli/output_file.h"
#include "tools/cli/progress.h"
#include "tools/cli/subcommand_options.h"
#include "tools/points/point_reader.h"
#include "tools/trade/median_edge.h"
#include "tools/trade/trade_page.h"
#include "tools/trade/trade_report.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMaxPoints = 1000000;
constexpr int kRounds = 3;
/// Queries that do not wait come at the rate of a haptic device, and not more than so many.
constexpr std::chrono::milliseconds kPace(1);
constexpr std::size_t kMaxPaced = 1000;

/// The points of a workload and their exact answers.
struct Workload {
  std::vector<Vec3> points;
  std::vector<ClosestPoint> exact;
};

QueryOptions options_of(const TradeSetting& setting) {
  QueryOptions options;
  options.max_error = setting.max_error;
  options.max_work = setting.max_work;
  options.wait = setting.wait;
  return options;
}

void answer_all(Probe& probe, std::span<const Vec3> points, const QueryOptions& options,
                std::vector<ClosestPoint>& answers) {
  answers.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    answers[i] = probe.closest_point(points[i], options);
}

/// Answers points one each kPace. Returns the processor time of the queries.
double answer_paced(Probe& probe, std::span<const Vec3> points, const QueryOptions& options,
                    std::vector<ClosestPoint>& answers) {
  answers.resize(points.size());
  double seconds = 0;
  auto due = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::this_thread::sleep_until(due);
    const double before = thread_seconds();
    answers[i] = probe.closest_point(points[i], options);
    seconds += thread_seconds() - before;
    due += kPace;
  }
  return seconds;
}

class Trade {
 public:
  Trade(const TradeArguments& arguments, Console& console)
      : arguments_(arguments),
        console_(console),
        progress_(arguments.quiet || arguments.json, false) {}

  int run() {
    // Before the measurements, which would be lost if the page could not be written.
    if (!arguments_.html.empty()) {
      if (const int status = open_page(); status != kDone) return status;
    }
    auto model = open_model(arguments_.file, open_options(arguments_.memory_bytes), console_);
    if (!model) return fail(model.error());
    if (const int status = measure_all(*model); status != kDone) return status;
    progress_.finish();
    if (const int status = report(); status != kDone) return status;
    const auto lost = pages_lost(model->stats());
    return console_.finish(lost ? fail(*lost) : kDone);
  }

 private:
  bool page_is_standard_output() const { return arguments_.html == "-"; }
  std::string page_name() const {
    return page_is_standard_output() ? "standard output" : arguments_.html.string();
  }

  int open_page() {
    if (page_is_standard_output() && console_.output_is_terminal())
      return console_.fail(
          page_name(),
          make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                     "a terminal cannot show a page; redirect standard output or name a file"));
    auto created = OutputFile::create(arguments_.html, arguments_.force);
    if (!created) return console_.fail(page_name(), created.error());
    page_.emplace(std::move(*created));
    return kDone;
  }

  int report() {
    const std::string text = arguments_.json ? trade_json(record_) : trade_words(record_);
    if (page_is_standard_output())
      console_.note(text);
    else
      console_.print(text);
    if (!page_) return kDone;
    const std::string html = trade_page(record_, trade_command(arguments_));
    auto written = page_->write(std::as_bytes(std::span(html)));
    if (written) written = page_->commit();
    return written ? kDone : console_.fail(page_name(), written.error());
  }

  int measure_all(const Model& model) {
    auto edge = median_edge(arguments_.file);
    if (!edge) return fail(edge.error());
    const ModelInfo& info = model.info();
    record_.file = arguments_.file.string();
    record_.triangles = info.triangles;
    record_.diagonal = core_diagonal(info);
    record_.median_edge = *edge;
    record_.whole_bytes = model.stats().table_bytes + std::uint64_t{info.pages} * info.page_bytes;
    if (!(record_.diagonal > 0)) return fail(no_extent());
    if (const int status = make_workloads(model); status != kDone) return status;
    const auto settings = trade_settings(record_.diagonal, record_.median_edge,
                                         arguments_.memory_bytes, record_.whole_bytes);
    progress_.start("measuring", settings.size() * workloads_.size(), "runs");
    for (const TradeSetting& setting : settings)
      if (const auto measured = measure(setting); !measured) return fail(measured.error());
    measure_times(model);
    return kDone;
  }

  static OpenOptions open_options(std::uint64_t memory_bytes) {
    OpenOptions options;
    options.memory_budget_bytes = memory_bytes;
    options.max_probes = 1;
    return options;
  }
  static Error no_extent() {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "all of its triangles are at one point; there is nothing to trade");
  }
  int fail(const Error& error) {
    progress_.finish();
    return console_.fail(arguments_.file.string(), error);
  }

  int make_workloads(const Model& model) {
    auto probe = Probe::create(model);
    if (!probe) return fail(probe.error());
    if (!arguments_.points.empty()) {
      record_.workloads = {TradeWorkload::kGiven};
      workloads_.resize(1);
      if (const int status = read_points(workloads_[0].points); status != kDone) return status;
    } else {
      for (const TradeWorkload workload : kMadeWorkloads) {
        record_.workloads.push_back(workload);
        workloads_.push_back({trade_points(model, *probe, workload, arguments_.count), {}});
      }
    }
    for (Workload& workload : workloads_) answer_all(*probe, workload.points, {}, workload.exact);
    return kDone;
  }

  int read_points(std::vector<Vec3>& points) {
    auto reader = open_points(arguments_.points.string(), console_.input());
    if (!reader) return console_.fail(points_name(arguments_.points.string()), reader.error());
    points.resize(arguments_.count);
    std::size_t size = 0;
    while (size < points.size()) {
      const auto count = (*reader)->read(std::span(points).subspan(size));
      if (!count) return console_.fail((*reader)->name(), count.error());
      if (*count == 0) break;
      size += *count;
    }
    points.resize(size);
    if (size > 0) return kDone;
    return console_.fail((*reader)->name(),
                         make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                                    "it has no point; give at least one, as a line x,y,z"));
  }

  /// Answers all points with a model of which no page is in memory. A budget that is too small for
  /// the model is noted.
  Result<void> measure(const TradeSetting& setting) {
    TradeRow row{setting, {}};
    for (const Workload& workload : workloads_) {
      const auto model = Model::open(arguments_.file, open_options(setting.memory_bytes));
      if (!model && setting.wait == Wait::kNever && model.error().code == ErrorCode::kNoMemory) {
        record_.too_small.push_back(setting.memory_bytes);
        return {};
      }
      if (!model) return model.error();
      auto probe = Probe::create(*model);
      if (!probe) return probe.error();
      const bool paced = setting.wait == Wait::kNever;
      const auto points =
          std::span(workload.points)
              .first(std::min(workload.points.size(), paced ? kMaxPaced : workload.points.size()));
      std::vector<ClosestPoint> answers;
      double seconds = 0;
      if (paced)
        seconds = answer_paced(*probe, points, options_of(setting), answers);
      else
        answer_all(*probe, points, options_of(setting), answers);
      row.results.push_back(
          compare_answers(answers, std::span(workload.exact).first(points.size())));
      row.results.back().seconds = seconds;
      row.results.back().pages = model->stats().pages_read;
      progress_.add(1);
    }
    record_.rows.push_back(std::move(row));
    return {};
  }

  /// Times the settings that wait for pages, in turn, with one model, after a round that is not
  /// timed.
  void measure_times(const Model& model) {
    for (std::size_t i = 0; i < workloads_.size(); ++i) {
      std::vector<std::function<void()>> actions;
      std::vector<ClosestPoint> answers;
      for (const TradeRow& row : record_.rows)
        if (row.setting.wait == Wait::kForPages)
          actions.emplace_back([&, options = options_of(row.setting)] {
            if (auto probe = Probe::create(model))
              answer_all(*probe, workloads_[i].points, options, answers);
          });
      for (const auto& action : actions) action();
      const std::vector<double> seconds = median_seconds(actions, kRounds);
      auto next = seconds.begin();
      for (TradeRow& row : record_.rows) {
        TradeResult& result = row.results[i];
        if (row.setting.wait == Wait::kForPages) result.seconds = *next++;
        result.ratio_to_exact =
            result.seconds / static_cast<double>(result.points) /
            (seconds.front() / static_cast<double>(workloads_[i].points.size()));
      }
    }
  }

  const TradeArguments& arguments_;
  Console& console_;
  Progress progress_;
  TradeRecord record_;
  std::vector<Workload> workloads_;
  std::optional<OutputFile> page_;
};

}  // namespace

int run_trade(const TradeArguments& arguments, Console& console) {
  return Trade(arguments, console).run();
}

void add_trade(CLI::App& app, Console& console, std::function<int()>& action) {
  const auto options = std::make_shared<TradeArguments>();
  SubcommandOptions subcommand(
      app, "trade", "Measure what allowed errors, limits of work and little memory save and cost");
  subcommand.require(
      subcommand.path("file", "FILE", options->file, "File that planetree build wrote"));
  subcommand.path("--points", "POINTS", options->points,
                  "Query the first points of this file (\"-\" is standard input) instead of three "
                  "workloads of made points: uniform, near the surface, and along it");
  subcommand.default_text(
      subcommand.count("--count", options->count, kMaxPoints, "Query points of each workload"),
      "2000");
  subcommand.default_text(subcommand.bytes("--memory", options->memory_bytes,
                                           "Maximum memory of queries that wait for pages"),
                          "256M");
  const auto html = subcommand.path(
      "--html", "OUT.html", options->html,
      "Also write the report as one HTML file with plots, which needs no network; - is standard "
      "output, and the report then goes to standard error");
  subcommand.need(subcommand.flag("--force", options->force, "Replace the page if it exists"),
                  html);
  subcommand.flag("--json", options->json, "Report as one JSON object");
  subcommand.flag("--quiet", options->quiet, "Show no progress");
  subcommand.on_given([options, &console, &action]() -> std::string {
    if (options->count == 0) return "--count 0 leaves nothing to measure; give 1 or more";
    action = [options, &console] { return run_trade(*options, console); };
    return {};
  });
}

}  // namespace planetree::tools
