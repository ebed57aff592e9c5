#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "tools/cli/output_file.h"
#include "tools/cli/subcommand.h"
#include "tools/cli/subcommand_options.h"

namespace planetree::tools {

/// Where a subcommand writes its report as a page, and whether it may replace a file.
struct PageChoice {
  std::filesystem::path html;  ///< empty: no page; "-" is standard output
  bool force = false;

  bool is_standard_output() const { return html == "-"; }
};

/// Declares the option --html, of a subcommand whose --force is for other files too.
SubcommandOptions::Option add_page_path(SubcommandOptions& subcommand, PageChoice& choice);
/// Declares the options --html and --force. Returns the first.
SubcommandOptions::Option add_page(SubcommandOptions& subcommand, PageChoice& choice);

/// A report as text, and as a page if one is wanted. The page appears only when it is complete.
class ReportPage {
 public:
  /// choice, console  must outlive this
  ReportPage(const PageChoice& choice, Console& console) : choice_(choice), console_(console) {}

  /// Makes the page's file, before measurements that would be lost if it could not be written. The
  /// page must neither be one of `inputs`, nor be shown by a terminal. Returns the exit status.
  int open(std::span<const std::filesystem::path> inputs);

  /// Prints the report, and writes the page that `page` returns. If that goes to standard output,
  /// the report goes to standard error. Returns the exit status.
  int report(const std::string& text, const std::function<std::string()>& page);

 private:
  int fail(const Error& error) const;

  const PageChoice& choice_;
  Console& console_;
  std::optional<OutputFile> file_;  // empty: no page
};

}  // namespace planetree::tools
