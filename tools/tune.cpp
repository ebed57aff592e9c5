#include "tools/tune.h"

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "tools/cli/duration_text.h"
#include "tools/cli/progress.h"
#include "tools/cli/subcommand_options.h"
#include "tools/tune/tune_page.h"
#include "tools/tune/tune_report.h"
#include "tools/tune/tune_run.h"

namespace planetree::tools {
namespace {

class Tune {
 public:
  Tune(const TuneArguments& arguments, Console& console)
      : arguments_(arguments),
        console_(console),
        progress_(arguments.quiet || arguments.json, false),
        run_(arguments, progress_),
        page_(arguments.page, console) {}

  int run() {
    if (const int status = page_.open(arguments_.traces); status != kDone) return status;
    if (arguments_.export_format == LookupExport::Format::kOracleGeneral &&
        console_.output_is_terminal())
      return console_.fail("standard output",
                           make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                                      "a terminal cannot show the export; redirect it to a file"));
    if (const auto failed = run_.read()) return fail(*failed);
    if (arguments_.export_format) return export_lookups();
    if (const auto failed = run_.measure()) return fail(*failed);
    progress_.finish();
    return console_.finish(report());
  }

 private:
  int fail(const TuneRun::Failure& failure) {
    progress_.finish();
    return console_.fail(failure.file, failure.error);
  }

  int export_lookups() {
    progress_.finish();
    const auto print = [this](std::span<const std::byte> piece) -> Result<void> {
      console_.print({reinterpret_cast<const char*>(piece.data()), piece.size()});
      return {};
    };
    (void)run_.lookups().write(*arguments_.export_format, run_.record().page_bytes, print);
    return console_.finish(kDone);
  }

  int report() {
    const TuneRecord& record = run_.record();
    const std::string text = arguments_.json ? tune_json(record) : tune_words(record);
    return page_.report(text, [&] { return tune_page(record, tune_command(arguments_)); });
  }

  const TuneArguments& arguments_;
  Console& console_;
  Progress progress_;
  TuneRun run_;
  ReportPage page_;
};

/// Declares an option whose text a function reads.
template <class Value>
SubcommandOptions::Option add_text(SubcommandOptions& subcommand, const std::string& name,
                                   const char* type, Result<Value> (*parse)(std::string_view),
                                   std::function<void(const std::string&, Value)> take,
                                   const std::string& help) {
  const auto complaint = [parse](const std::string& text) {
    const auto value = parse(text);
    return value ? std::string() : std::string(value.error().text);
  };
  return subcommand.text(
      name, type, complaint, [parse, take](const std::string& text) { take(text, *parse(text)); },
      help);
}

}  // namespace

int run_tune(const TuneArguments& arguments, Console& console) {
  return Tune(arguments, console).run();
}

void add_tune(CLI::App& app, Console& console, std::function<int()>& action) {
  const auto options = std::make_shared<TuneArguments>();
  SubcommandOptions subcommand(
      app, "tune", "Tell from recorded sessions how much memory they need, and what policy");
  subcommand.require(subcommand.paths(
      "traces", "TRACE...", options->traces,
      "Files that planetree touch --trace or planetree query --trace wrote, of one model"));
  add_text<TuneGoal>(
      subcommand, "--recommend", "GOAL", &TuneGoal::parse,
      [options](const std::string& text, TuneGoal goal) {
        options->goal = goal;
        options->goal_text = text;
      },
      "Find the least memory with which other sessions of the kind keep a goal: degraded<0.1% "
      "(share of the answers), width<W (99 % quantile, model units), ticks<N (99 % quantile of "
      "degraded answers in a row) or misses<M (pages read a blocking query)");
  subcommand.default_text(
      add_text<std::uint64_t>(
          subcommand, "--latency", "TIME", &parse_latency,
          [options](const std::string&, std::uint64_t ns) { options->latency_ns = ns; },
          "Time in which a page arrives in replayed sessions, such as 85us"),
      "as recorded if the disk was simulated, else 85us");
  add_text<std::vector<std::uint64_t>>(
      subcommand, "--pages", "SIZES", &parse_page_sizes,
      [options](const std::string&, std::vector<std::uint64_t> sizes) {
        options->page_sizes = std::move(sizes);
      },
      "Estimate misses with other page sizes, such as 16K,64K,256K, without files of these sizes");
  subcommand.path("--model", "FILE", options->model,
                  "The model of the traces, if it is neither where it was recorded nor beside the "
                  "first trace");
  const auto exported = subcommand.word(
      "--export", {"csv", "oracleGeneral"},
      [options](const std::string& word) {
        options->export_format =
            word == "csv" ? LookupExport::Format::kCsv : LookupExport::Format::kOracleGeneral;
      },
      "Write the page lookups to standard output, for simulators of caches, instead of a report");
  const auto html = add_page(subcommand, options->page);
  SubcommandOptions::exclude(html, exported);
  subcommand.flag("--json", options->json, "Report as one JSON object");
  subcommand.flag("--quiet", options->quiet, "Show no progress");
  subcommand.on_given([options, &console, &action]() -> std::string {
    action = [options, &console] { return run_tune(*options, console); };
    return {};
  });
}

}  // namespace planetree::tools
