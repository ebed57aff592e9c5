#include "tools/verify.h"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/check/file_check.h"
#include "tools/check/file_parts.h"
#include "tools/cli/progress.h"
#include "tools/cli/size_text.h"
#include "tools/cli/subcommand_options.h"
#include "tools/set/set_survey.h"

namespace planetree::tools {
namespace {

std::string json_report(const VerifyArguments& arguments, const CheckReport& report) {
  nlohmann::ordered_json issues = nlohmann::ordered_json::array();
  for (const Issue& issue : report.issues.kept()) issues.push_back(issue_json(issue));
  return json_line({{"file", arguments.file.string()},
                    {"full", arguments.full},
                    {"pages", report.pages},
                    {"nodes", report.nodes},
                    {"blocks", report.blocks},
                    {"triangles", report.triangles},
                    {"issue_count", report.issues.count()},
                    {"issues", issues}});
}

const char* remark(const VerifyArguments& arguments, const CheckReport& report) {
  if (report.issues.count() > 0) return "; restore the file from a copy or build it again";
  return arguments.full ? "" : " (--full also checks every triangle and the mask)";
}

std::string plain_report(const VerifyArguments& arguments, const CheckReport& report,
                         std::uint32_t page_count) {
  const std::string file = arguments.file.string();
  std::string text;
  for (const Issue& issue : report.issues.kept())
    text += fmt::format("{}: {}\n", file, issue_text(issue));
  const std::uint64_t unlisted = report.issues.count() - report.issues.kept().size();
  if (unlisted > 0) text += fmt::format("{}: ... and {} more\n", file, grouped_count(unlisted));
  const std::string found = report.issues.count() == 0 ? "no issue"
                            : report.issues.count() == 1
                                ? "1 issue"
                                : grouped_count(report.issues.count()) + " issues";
  return text + fmt::format("{}: {}; read {} of {} pages, {} nodes, {} blocks, {} triangles{}\n",
                            file, found, grouped_count(report.pages), grouped_count(page_count),
                            grouped_count(report.nodes), grouped_count(report.blocks),
                            grouped_count(report.triangles), remark(arguments, report));
}

}  // namespace

int run_verify(const VerifyArguments& arguments, Console& console) {
  const storage::HttpOptions http{arguments.source.directory, arguments.source.bytes, {}};
  auto parts = FileParts::open(arguments.file, storage::FileCalls::real(), http);
  if (!parts) return console.fail(arguments.file.string(), parts.error());
  if (const auto members = SetSurvey::of(*parts, arguments.full)) members->add_issues(*parts);
  Progress progress(arguments.quiet, arguments.json);
  progress.start("verifying", parts->page_count(), "pages");
  const CheckReport report =
      check_file(*parts, arguments.full, [&progress](std::uint32_t) { progress.add(1); });
  progress.finish();
  console.print(arguments.json ? json_report(arguments, report)
                               : plain_report(arguments, report, parts->page_count()));
  return console.finish(report.issues.count() > 0 ? kDataAtFault : kDone);
}

void add_verify(CLI::App& app, Console& console, std::function<int()>& action) {
  const auto options = std::make_shared<VerifyArguments>();
  SubcommandOptions subcommand(app, "verify", "Check a .ptree file or a set against its format");
  subcommand.require(
      subcommand.path("file", "FILE", options->file, "File or set to verify, or a URL of one"));
  subcommand.flag(
      "--full", options->full,
      "Also check every triangle and vertex, the bounds, the mask and the height fields, and the "
      "hash of each member of a set");
  add_http_cache(subcommand, options->source);
  subcommand.flag("--json", options->json,
                  "Report as one JSON object; progress as JSON lines, on standard error");
  subcommand.flag("--quiet", options->quiet, "Show no progress");
  subcommand.on_given([options, &console, &action] {
    action = [options, &console] { return run_verify(*options, console); };
    return std::string();
  });
}

}  // namespace planetree::tools
