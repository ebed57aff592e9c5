#include "tools/inspect.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "tools/check/file_parts.h"
#include "tools/cli/progress.h"
#include "tools/cli/subcommand_options.h"
#include "tools/report/explanation.h"
#include "tools/report/file_survey.h"
#include "tools/report/inspect_page.h"
#include "tools/report/level_report.h"
#include "tools/report/page_report.h"
#include "tools/report/summary_report.h"
#include "tools/set/set_survey.h"
#include "tools/slice/show_slice.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMaxLevel = 255;  // of the tree

class Inspection {
 public:
  /// members  of a set
  Inspection(const InspectArguments& arguments, Console& console, FileParts& parts,
             std::optional<SetSurvey> members)
      : arguments_(arguments), console_(console), parts_(parts), members_(std::move(members)) {}

  int show_all();
  int show_page(std::uint32_t page);
  int show_nodes();

 private:
  void print(const std::string& text);
  FileSurvey survey(Json& page_rows, PageTally& tally);
  std::string all_text(const InspectRecord& record) const;
  std::string all_json(const InspectRecord& record, Json page_rows) const;
  int print_issues(const IssueList& issues);
  void print_issue(const Issue& issue);
  Json issues_json(const IssueList& issues) const;

  const InspectArguments& arguments_;
  Console& console_;
  FileParts& parts_;
  const std::optional<SetSurvey> members_;
};

Error refusal(const std::string& text) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere, "%s", text.c_str());
}

void Inspection::print_issue(const Issue& issue) {
  fmt::print(console_.errors(), "planetree: {}: {}\n", arguments_.file.string(), issue_text(issue));
}

/// Prints the first few issues; `verify` lists all. Returns the exit status.
int Inspection::print_issues(const IssueList& issues) {
  constexpr std::size_t kMaxListed = 10;
  if (issues.count() == 0) return kDone;
  std::fflush(console_.output());
  const std::size_t listed = std::min(issues.kept().size(), kMaxListed);
  for (std::size_t i = 0; i < listed; ++i) print_issue(issues.kept()[i]);
  if (issues.count() > listed)
    fmt::print(console_.errors(), "planetree: {}: {} more issues; planetree verify lists them\n",
               arguments_.file.string(), issues.count() - listed);
  return kDataAtFault;
}

Json Inspection::issues_json(const IssueList& issues) const {
  Json array = Json::array();
  for (const Issue& issue : issues.kept()) array.push_back(issue_json(issue));
  return array;
}

/// Prints a part of the report, to standard error if the page goes to standard output.
void Inspection::print(const std::string& text) {
  if (arguments_.html.is_standard_output())
    console_.note(text);
  else
    console_.print(text);
}

FileSurvey Inspection::survey(Json& page_rows, PageTally& tally) {
  const bool print_rows = arguments_.pages && !arguments_.json;
  Progress progress(arguments_.quiet || (print_rows && console_.output_is_terminal()),
                    arguments_.json);
  progress.start("reading", parts_.page_count(), "pages");
  if (print_rows && parts_.page_count() > 0) print(page_heading());
  return survey_file(parts_, [&](const PageRow& row) {
    progress.add(1);
    tally.add(row);
    if (!arguments_.pages) return true;
    if (arguments_.json)
      page_rows.push_back(page_json(row));
    else if (arguments_.html.html.empty())
      return console_.print(page_line(row));
    else
      print(page_line(row));
    return true;
  });
}

int Inspection::show_all() {
  ReportPage page(arguments_.html, console_);
  if (const int status = page.open(std::span(&arguments_.file, 1)); status != kDone) return status;
  Json page_rows = Json::array();
  InspectRecord record{arguments_.file.string(), {}, {}, PageTally(parts_)};
  record.survey = survey(page_rows, record.pages);
  record.summary = summary_json(parts_, record.survey);
  const std::string text =
      arguments_.json ? all_json(record, std::move(page_rows)) : all_text(record);
  const int status = page.report(text, [&] {
    return inspect_page(record, inspect_command(arguments_.file, arguments_.html.html));
  });
  const IssueList& issues = record.survey.issues;
  const int faults = !arguments_.json     ? print_issues(issues)
                     : issues.count() > 0 ? kDataAtFault
                                          : kDone;
  return console_.finish(std::max(status, faults));
}

std::string Inspection::all_text(const InspectRecord& record) const {
  return (arguments_.levels ? levels_text(record.survey) : std::string()) +
         summary_text(record.file, parts_, record.survey) +
         (members_ ? members_->text(parts_) : std::string());
}

std::string Inspection::all_json(const InspectRecord& record, Json page_rows) const {
  Json json = {{"file", record.file}};
  json.update(record.summary);
  if (members_) json["members"] = members_->json(parts_);
  if (arguments_.levels) {
    json["by_level"] = levels_json(record.survey);
    json["mask_by_level"] = mask_levels_json(record.survey);
  }
  if (arguments_.pages) json["by_page"] = std::move(page_rows);
  json["issue_count"] = record.survey.issues.count();
  json["issues"] = issues_json(record.survey.issues);
  return json_line(json);
}

int Inspection::show_page(std::uint32_t page) {
  IssueList issues;
  for (const Issue& issue : parts_.issues()) issues.add(issue);
  PageRow row{page, parts_.entries()[page], {}, {}, {}, {}, false};
  std::optional<Issue> issue = parts_.read_page(page);
  const bool mask = page >= parts_.first_mask_page();
  const bool field = parts_.is_field_page(page);
  const bool attributes = parts_.is_attribute_page(page);
  row.is_of_caps = !mask && !field && !attributes && page >= parts_.first_cap_page();
  if (octree::RawStreams streams; !issue && !mask && !field && !attributes && parts_.read(streams))
    row.head = streams.head;
  if (!issue) row.mask = parts_.mask_head();
  if (!issue) row.field = parts_.field_head();
  if (!issue) row.attributes = parts_.attribute_head();
  if (!issue) issue = parts_.decode_page();
  Json details = page_details(parts_, row, !issue);
  if (issue) issues.add(*issue);
  if (!arguments_.json) {
    console_.print(page_details_text(details));
    return console_.finish(print_issues(issues));
  }
  details["issues"] = issues_json(issues);
  console_.print(json_line(details));
  return console_.finish(issues.count() > 0 ? kDataAtFault : kDone);
}

/// Shows the root nodes of all distance pages whose octcode matches; several pages may share one.
int Inspection::show_nodes() {
  IssueList issues;
  for (const Issue& issue : parts_.issues()) issues.add(issue);
  Json pages = Json::array();
  for (std::uint32_t page = 0; page < parts_.first_cap_page(); ++page) {
    const storage::PageEntry& entry = parts_.entries()[page];
    if (!arguments_.node->matches(entry.octcode)) continue;
    Json json = {{"page", page},
                 {"octcode", fmt::format("0x{:016x}", entry.octcode)},
                 {"cell", cell_text(entry.octcode)},
                 {"nodes", Json::array()}};
    std::optional<Issue> issue = parts_.load_page(page);
    if (issue)
      issues.add(*issue);
    else
      json["nodes"] = nodes_json(parts_, true);
    pages.push_back(std::move(json));
  }
  if (pages.empty()) {
    const Error error =
        refusal("no page has that octcode; --pages lists the octcodes of all pages");
    return std::max(print_issues(issues), console_.fail(arguments_.file.string(), error));
  }
  if (arguments_.json) {
    console_.print(json_line({{"pages", pages}, {"issues", issues_json(issues)}}));
    return console_.finish(issues.count() > 0 ? kDataAtFault : kDone);
  }
  for (const Json& page : pages)
    console_.print(fmt::format("page {} at {} ({})\n{}", page["page"].dump(),
                               page["cell"].get<std::string>(), page["octcode"].get<std::string>(),
                               nodes_text(page["nodes"])));
  return console_.finish(print_issues(issues));
}

int show_why(const InspectArguments& arguments, Console& console) {
  const auto explanation = explain(arguments.file, *arguments.why);
  if (!explanation) return console.fail(arguments.file.string(), explanation.error());
  console.print(arguments.json ? json_line(explanation_json(*explanation))
                               : explanation_text(*explanation));
  return console.finish(explanation->pages_lost ? kDataAtFault : kDone);
}

std::string why_complaint(const std::string& text) {
  if (parse_point(text)) return {};
  return fmt::format("'{}' is not a point; give three numbers as X,Y,Z", text);
}

std::string node_complaint(const std::string& text) {
  if (OctcodeQuery::parse(text)) return {};
  return fmt::format("'{}' is not an octcode; give 0x... or level:x:y:z", text);
}

SliceArguments slice_of(const InspectArguments& arguments) {
  SliceArguments slice = arguments.slice;
  slice.file = arguments.file;
  slice.replace_image = arguments.html.force;
  slice.json = arguments.json;
  slice.quiet = arguments.quiet;
  return slice;
}

BoundsArguments bounds_of(const InspectArguments& arguments) {
  return {arguments.file,       arguments.bounds.output, arguments.bounds.level,
          arguments.html.force, arguments.json,          arguments.quiet};
}

}  // namespace

int run_inspect(const InspectArguments& arguments, Console& console) {
  if (arguments.slice.plane) return show_slice(slice_of(arguments), console);
  if (!arguments.bounds.output.empty()) return show_bounds(bounds_of(arguments), console);
  if (arguments.why) return show_why(arguments, console);
  const std::string file = arguments.file.string();
  const storage::HttpOptions http{arguments.source.directory, arguments.source.bytes, {}};
  auto parts = FileParts::open(arguments.file, storage::FileCalls::real(), http);
  if (!parts) return console.fail(file, parts.error());
  auto members = SetSurvey::of(*parts, false);
  if (members) members->add_issues(*parts);
  Inspection inspection(arguments, console, *parts, std::move(members));
  // A file without a readable header or directory has no pages to show.
  const bool has_pages = parts->page_count() > 0;
  if (arguments.node && has_pages) return inspection.show_nodes();
  if (!arguments.page || !has_pages) return inspection.show_all();
  if (*arguments.page >= parts->page_count())
    return console.fail(file, refusal(fmt::format("there is no page {}; the last page is {}",
                                                  *arguments.page, parts->page_count() - 1)));
  return inspection.show_page(static_cast<std::uint32_t>(*arguments.page));
}

void add_inspect(CLI::App& app, Console& console, std::function<int()>& action) {
  struct Options {
    InspectArguments arguments;
    std::uint64_t page = 0;
  };
  const auto options = std::make_shared<Options>();
  InspectArguments& arguments = options->arguments;
  SubcommandOptions subcommand(
      app, "inspect", "Show the contents of a .ptree file or a set, also of a damaged one");
  subcommand.require(
      subcommand.path("file", "FILE", arguments.file, "File or set to inspect, or a URL of one"));
  subcommand.flag("--levels", arguments.levels,
                  "Add a row for each depth of the tree and each level of the mask");
  subcommand.flag("--pages", arguments.pages,
                  "Add a row for each page; its octcode is shown as level/x/y/z");
  const auto node = subcommand.text(
      "--node", "OCTCODE", node_complaint,
      [&arguments](const std::string& text) { arguments.node = OctcodeQuery::parse(text); },
      "Show instead the root nodes of the pages with this octcode (0x... or level:x:y:z): boxes, "
      "children and discs, relative to the model's centre");
  const auto page =
      subcommand.count("--page", options->page, std::numeric_limits<std::uint32_t>::max(),
                       "Show instead one page, numbered from 0, with the names of format-spec");
  const SliceOptions slices = add_slice_options(subcommand, arguments.slice);
  const auto why = subcommand.text(
      "--why", "X,Y,Z", why_complaint,
      [&arguments](const std::string& text) { arguments.why = parse_point(text); },
      "Show instead one answer and how it was found: cell of the mask, rule that decided the side, "
      "crossings, nearest triangle, work (model units)");
  subcommand.exclude(why, node);
  subcommand.exclude(why, page);
  subcommand.exclude(page, node);
  const auto bounds =
      subcommand.count_and_path("--export-bounds", "LEVEL OUT.ply", arguments.bounds.level,
                                kMaxLevel, arguments.bounds.output, bounds_complaint,
                                "Write instead the bounding planes of a level of the tree as a "
                                "mesh: discs as polygons in both "
                                "planes of each slab. The root has level 0. - is standard output");
  const auto html = add_page_path(subcommand, arguments.html);
  for (const auto other : {node, page, why, bounds, html}) subcommand.exclude(slices.slice, other);
  for (const auto other : {node, page, why, html}) subcommand.exclude(bounds, other);
  for (const auto other : {node, page, why}) subcommand.exclude(html, other);
  const auto force = subcommand.flag("--force", arguments.html.force,
                                     "Replace the file of --image, --export-bounds or --html if it "
                                     "exists");
  add_http_cache(subcommand, arguments.source);
  subcommand.flag("--json", arguments.json,
                  "Report as one JSON object; progress as JSON lines, on standard error");
  subcommand.flag("--quiet", arguments.quiet, "Show no progress");
  subcommand.on_given([options, page, slices, bounds, html, force, &console,
                       &action]() -> std::string {
    const auto given = [](SubcommandOptions::Option one) { return SubcommandOptions::given(one); };
    if (given(force) && !given(slices.image) && !given(bounds) && !given(html))
      return "--force replaces a file; add --image, --export-bounds or --html";
    if (std::string complaint = slices.complaint(options->arguments.slice); !complaint.empty())
      return complaint;
    if (given(page)) options->arguments.page = options->page;
    action = [options, &console] { return run_inspect(options->arguments, console); };
    return {};
  });
}

}  // namespace planetree::tools
