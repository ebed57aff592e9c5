#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace planetree::tools {

/// How a page is opened.
struct BrowserWindow {
  int width = 1440;
  bool is_dark = false;
  bool has_webgl = false;  ///< drawn in software
};

/// What a page did in a browser.
struct BrowserVisit {
  nlohmann::json report;                ///< what the examination returned; null if it threw
  std::vector<std::string> complaints;  ///< errors of the console, and violations of the policy
  std::vector<std::string> requests;    ///< addresses asked for, other than the page's own
};

/// A browser without a window.
class Browser {
 public:
  /// Whether the machine has one that the tests know: Debian's chromium or chromium-headless-shell.
  static bool is_here();
  static constexpr const char* kMissing =
      "this machine has no chromium; ./dev setup installs chromium-headless-shell";

  /// Opens a copy of the page to which a script is added that runs an examination.
  ///
  /// folder       for the copy and the browser's files
  /// examination  the body of a function in JavaScript; it returns what `report` becomes
  static BrowserVisit visit(const std::string& html, const std::string& examination,
                            const BrowserWindow& window, const std::filesystem::path& folder);
  /// Opens an address on this machine, and looks at the page after `budget_ms` of its own time. The
  /// page itself puts what becomes the visit into the attribute `data-visit` of its body, as
  /// encodeURIComponent of {report, complaints, requests}. Requests of the network's log to other
  /// addresses than those that start with `own` are added.
  static BrowserVisit visit_address(const std::string& address, const std::string& own,
                                    const BrowserWindow& window, int budget_ms,
                                    const std::filesystem::path& folder);
};

}  // namespace planetree::tools
