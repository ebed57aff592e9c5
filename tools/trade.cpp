#include "tools/trade.h"

#include <filesystem>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "tools/cli/layer_option.h"
#include "tools/cli/open_model.h"
#include "tools/cli/parts_option.h"
#include "tools/cli/progress.h"
#include "tools/cli/report_page.h"
#include "tools/cli/subcommand_options.h"
#include "tools/points/row_reader.h"
#include "tools/trade/median_edge.h"
#include "tools/trade/trade_measurement.h"
#include "tools/trade/trade_page.h"
#include "tools/trade/trade_report.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMaxPoints = 1000000;

class Trade {
 public:
  Trade(const TradeArguments& arguments, Console& console)
      : arguments_(arguments),
        console_(console),
        progress_(arguments.quiet || arguments.json, false),
        measurement_(arguments.file, record_, [this] { progress_.add(1); }),
        page_(arguments.page, console) {}

  int run() {
    const std::filesystem::path inputs[] = {arguments_.file, arguments_.points};
    if (const int status = page_.open(inputs); status != kDone) return status;
    auto model = open_model(
        arguments_.file, trade_open_options(arguments_.memory_bytes, arguments_.layers), console_);
    if (!model) return fail(model.error());
    if (const int status = measure_all(*model); status != kDone) return status;
    progress_.finish();
    if (const int status = report(); status != kDone) return console_.finish(status);
    const auto lost = pages_lost(*model);
    return console_.finish(lost ? fail(*lost) : kDone);
  }

 private:
  int report() {
    const std::string text = arguments_.json ? trade_json(record_) : trade_words(record_);
    return page_.report(text, [this] { return trade_page(record_, trade_command(arguments_)); });
  }

  int measure_all(const Model& model) {
    auto edge = median_edge(arguments_.file);
    if (!edge) return fail(edge.error());
    const ModelInfo& info = model.info();
    record_.file = arguments_.file.string();
    record_.triangles = info.triangles;
    record_.file_layers = info.layers;
    record_.layers = model.stats().layers;
    record_.parts = arguments_.parts & parts_told(model);
    record_.diagonal = core_diagonal(info);
    record_.median_edge = *edge;
    record_.whole_bytes = model.stats().table_bytes + std::uint64_t{info.pages} * info.page_bytes;
    if (!(record_.diagonal > 0)) return fail(no_extent());
    if (const int status = make_workloads(model); status != kDone) return status;
    const auto settings = trade_settings(record_.diagonal, record_.median_edge,
                                         arguments_.memory_bytes, record_.whole_bytes);
    progress_.start("measuring", settings.size() * record_.workloads.size(), "runs");
    for (const TradeSetting& setting : settings)
      if (const auto measured = measurement_.measure(setting); !measured)
        return fail(measured.error());
    measurement_.measure_times(model);
    return kDone;
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
    if (arguments_.points.empty()) {
      for (const TradeWorkload workload : kMadeWorkloads)
        measurement_.add(workload, trade_points(model, *probe, workload, arguments_.count), *probe);
      return kDone;
    }
    std::vector<Vec3> points;
    if (const int status = read_points(points); status != kDone) return status;
    measurement_.add(TradeWorkload::kGiven, std::move(points), *probe);
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

  const TradeArguments& arguments_;
  Console& console_;
  Progress progress_;
  TradeRecord record_;
  TradeMeasurement measurement_;
  ReportPage page_;
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
  subcommand.path(
      "--points", "POINTS", options->points,
      "Query the first points of this file, in any format that planetree query reads (\"-\" "
      "is standard input), instead of three workloads of made points: uniform, near the surface, "
      "and along it");
  subcommand.default_text(
      subcommand.count("--count", options->count, kMaxPoints, "Query points of each workload"),
      "2000");
  subcommand.default_text(subcommand.bytes("--memory", options->memory_bytes,
                                           "Maximum memory of queries that wait for pages"),
                          "256M");
  add_parts(
      subcommand, [options](std::uint32_t parts) { options->parts = parts; },
      "Answers without the normal need no triangle, so that an allowed error saves more");
  add_open_layers(subcommand, options->layers);
  add_page(subcommand, options->page);
  subcommand.flag("--json", options->json, "Report as one JSON object");
  subcommand.flag("--quiet", options->quiet, "Show no progress");
  subcommand.on_given([options, &console, &action]() -> std::string {
    if (options->count == 0) return "--count 0 leaves nothing to measure; give 1 or more";
    if ((options->parts & (kDistance | kNormal)) == 0)
      return "--parts side leaves no distance to measure; add distance";
    action = [options, &console] { return run_trade(*options, console); };
    return {};
  });
}

}  // namespace planetree::tools
