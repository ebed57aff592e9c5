#include "tools/cli/report_page.h"

#include <utility>

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

Error refusal(const char* text) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere, "%s", text);
}

}  // namespace

SubcommandOptions::Option add_page_path(SubcommandOptions& subcommand, PageChoice& choice) {
  return subcommand.path(
      "--html", "OUT.html", choice.html,
      "Also write the report as one HTML file with plots, which needs no network; - is standard "
      "output, and the report then goes to standard error");
}

SubcommandOptions::Option add_page(SubcommandOptions& subcommand, PageChoice& choice) {
  const auto html = add_page_path(subcommand, choice);
  SubcommandOptions::need(subcommand.flag("--force", choice.force, "Replace the page if it exists"),
                          html);
  return html;
}

int ReportPage::fail(const Error& error) const {
  return console_.fail(choice_.is_standard_output() ? "standard output" : choice_.html.string(),
                       error);
}

int ReportPage::open(std::span<const fs::path> inputs) {
  if (choice_.html.empty()) return kDone;
  if (choice_.is_standard_output() && console_.output_is_terminal())
    return fail(refusal("a terminal cannot show a page; redirect standard output or name a file"));
  if (const auto checked = check_is_no_input(choice_.html, inputs); !checked)
    return fail(checked.error());
  auto created = OutputFile::create(choice_.html, choice_.force);
  if (!created) return fail(created.error());
  file_.emplace(std::move(*created));
  return kDone;
}

int ReportPage::report(const std::string& text, const std::function<std::string()>& page) {
  if (choice_.is_standard_output())
    console_.note(text);
  else
    console_.print(text);
  if (!file_) return kDone;
  const std::string html = page();
  auto written = file_->write(std::as_bytes(std::span(html)));
  if (written) written = file_->commit();
  return written ? kDone : fail(written.error());
}

}  // namespace planetree::tools
