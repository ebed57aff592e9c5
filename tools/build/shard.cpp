#include "tools/build/shard.h"

#include <fmt/format.h>

#include <memory>

#include "planetree/shard.h"
#include "tools/build/build_meter.h"
#include "tools/build/build_options.h"
#include "tools/build/build_report.h"
#include "tools/build/shard_report.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {
namespace {

/// Reports a step that wrote a file of the job.
template <class Report>
int report_step(const ShardArguments& arguments, BuildMeter& meter,
                const std::filesystem::path& job, const Result<Report>& report, Console& console) {
  meter.finish();
  if (!report) return console.fail(name_of_failure(meter, arguments.meshes), report.error());
  const ShardRecord record{arguments.step, job, arguments.shard.value_or(0), meter.seconds()};
  console.print(arguments.json ? json_report(record, *report) : plain_report(record, *report));
  return console.finish(kDone);
}

int run_plan(const ShardArguments& arguments, Console& console) {
  BuildMeter meter(arguments.output, arguments.quiet, arguments.json, console);
  const auto report =
      plan_shards(arguments.meshes, arguments.output, static_cast<std::uint32_t>(arguments.shards),
                  meter.observed(arguments.options));
  if (report && report->skipped > 0)
    console.warn(mesh_name(arguments.meshes),
                 fmt::format("{} triangle{} of bad records skipped; repair the mesh, or use "
                             "--strict to refuse it",
                             grouped_count(report->skipped), report->skipped == 1 ? "" : "s"));
  return report_step(arguments, meter, arguments.output, report, console);
}

int run_part(const ShardArguments& arguments, Console& console) {
  BuildMeter meter(arguments.job, arguments.quiet, arguments.json, console);
  const auto step = arguments.step == "map" ? map_shard : reduce_shard;
  const auto report =
      step(arguments.job, arguments.shard.value_or(0), meter.observed(arguments.options));
  return report_step(arguments, meter, arguments.job, report, console);
}

int run_merge(const ShardArguments& arguments, Console& console) {
  BuildMeter meter(arguments.output, arguments.quiet, arguments.json, console);
  const auto report =
      merge_shards(arguments.job, arguments.output, meter.observed(arguments.options));
  const std::vector<std::filesystem::path> job{arguments.job};
  return report_build(report, meter, {job, arguments.output}, arguments.json, console);
}

// Whether an option is given that only the plan has.
bool has_content(const BuildOptions& given) {
  const BuildOptions none;
  return given.page_bytes != none.page_bytes || given.side != none.side ||
         given.layers != none.layers || given.keep != none.keep || given.float64 != none.float64 ||
         given.strict != none.strict || !given.metadata.empty();
}

std::string complaint_of(const ShardArguments& arguments) {
  const std::string& step = arguments.step;
  const bool plans = step == "plan", merges = step == "merge";
  if ((plans || merges) && arguments.output.empty())
    return fmt::format("{} needs -o {}", step, plans ? "JOB" : "OUT.ptree");
  if (!plans && !merges && !arguments.output.empty())
    return fmt::format("{} writes into the job; leave out -o", step);
  if (plans && arguments.shards == 0) return "plan needs --shards N, the number of parts";
  if (!plans && arguments.shards > 0)
    return fmt::format("--shards is for plan; {} takes it from the job", step);
  if (!plans && has_content(arguments.options))
    return fmt::format("what the file contains is decided by plan; give {} no such option", step);
  if (!merges && arguments.options.replace) return "--force is for merge";
  return {};
}

// Takes what stands behind the name of the step. Returns a complaint, or an empty text.
std::string take_paths(const std::vector<std::filesystem::path>& paths, ShardArguments& arguments) {
  const std::string& step = arguments.step;
  if (step == "plan") {
    arguments.meshes = paths;
    return {};
  }
  arguments.job = paths.front();
  if (step == "merge")
    return paths.size() == 1 ? std::string() : "merge takes no number of a shard; give one job";
  if (paths.size() == 1) return fmt::format("{} needs the number of a shard, from 0", step);
  if (paths.size() > 2) return fmt::format("{} takes one job and the number of one shard", step);
  const auto shard = parse_count(paths[1].string());
  if (!shard) return shard.error().text;
  if (*shard >= kMaxShards)
    return fmt::format("{} is too large for a shard; give at most {}", *shard, kMaxShards - 1);
  arguments.shard = static_cast<std::uint32_t>(*shard);
  return {};
}

}  // namespace

int run_shard(const ShardArguments& arguments, Console& console) {
  if (arguments.step == "plan") return run_plan(arguments, console);
  return arguments.step == "merge" ? run_merge(arguments, console) : run_part(arguments, console);
}

void add_shard(CLI::App& app, Console& console, std::function<int()>& action) {
  struct Options {
    ShardArguments arguments;
    BuildOptionTexts texts;
    std::vector<std::filesystem::path> paths;
  };
  const auto options = std::make_shared<Options>();
  ShardArguments& arguments = options->arguments;
  SubcommandOptions subcommand(app, "shard", "Build a .ptree file step by step, by many processes");
  subcommand.require(subcommand.word(
      "step", {"plan", "map", "reduce", "merge"},
      [&arguments](const std::string& step) { arguments.step = step; },
      "plan: read the mesh, of one file or several, and write the job -o JOB, a directory that all "
      "machines share. "
      "map: sort part N of the triangles. reduce, after all of map: build part N of the tree. "
      "merge, after all of reduce: write -o OUT.ptree, with the bytes that planetree build writes. "
      "A step can be killed and run again; one that was done does nothing"));
  subcommand.require(subcommand.paths(
      "path", "PATH...", options->paths,
      "The files of the mesh for plan; the job for the other steps and, behind it, the number N of "
      "the part for map and reduce, from 0"));
  subcommand.path("-o,--output", "PATH", arguments.output,
                  "Directory of the job, for plan; the file to write, for merge");
  subcommand.count("--shards", arguments.shards, kMaxShards,
                   "Number of parts, for plan. The file does not depend on it");
  add_resources(subcommand, arguments.options, options->texts);
  subcommand.path("--temp-dir", "DIR", arguments.options.temp_directory,
                  "Directory for temporary files, which vanish with the process; by default the "
                  "job, or for merge that of the output");
  const KeepOptions keep = add_content(subcommand, arguments.options, options->texts);
  subcommand.flag("--force", arguments.options.replace, "Replace the output of merge if it exists");
  subcommand.flag("--json", arguments.json,
                  "Report as one JSON object; progress as JSON lines, on standard error");
  subcommand.flag("--quiet", arguments.quiet, "Show no progress");
  subcommand.on_given([options, keep, &console, &action] {
    ShardArguments& given = options->arguments;
    action = [options, &console] { return run_shard(options->arguments, console); };
    for (const std::string& complaint :
         {take_paths(options->paths, given), take_texts(options->texts, keep, given.options)})
      if (!complaint.empty()) return complaint;
    return complaint_of(given);
  });
}

}  // namespace planetree::tools
