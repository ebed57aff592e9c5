#include "tests/tools/html/browser.h"

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>

#include "tools/cli/shell_word.h"

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

/// Runs before all of the page's scripts.
constexpr const char* kWatch = R"js(<script>
window.seen = [];
addEventListener('error', (event) => seen.push('error: ' + event.message));
addEventListener('securitypolicyviolation', (event) => seen.push('policy: ' + event.blockedURI));
for (const kind of ['error', 'warn'])
  console[kind] = (...words) => seen.push(kind + ': ' + words.join(' '));
</script>)js";

/// Runs after them. Violations are reported by events that come later.
constexpr const char* kReport = R"js(<script>
addEventListener('load', () => {
  let report = null;
  try {
    report = (() => {EXAMINATION})();
  } catch (error) {
    seen.push('error: ' + error.stack);
  }
  setTimeout(() => {
    const own = location.href;
    const requests = performance.getEntriesByType('resource').map((entry) => entry.name)
      .filter((name) => name !== own);
    document.body.setAttribute('data-visit', encodeURIComponent(
      JSON.stringify({report, complaints: seen, requests})));
  }, 0);
});
</script>)js";

std::string output_of(const std::string& command) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(::popen(command.c_str(), "r"),
                                                             ::pclose);
  std::string output;
  char bytes[4096];
  while (pipe) {
    const std::size_t count = std::fread(bytes, 1, sizeof bytes, pipe.get());
    if (count == 0) break;
    output.append(bytes, count);
  }
  return output;
}

const std::string& program() {
  static const std::string path = [] {
    std::string found =
        output_of("command -v chromium-headless-shell || command -v chromium || true");
    while (found.ends_with('\n')) found.pop_back();
    return found;
  }();
  return path;
}

std::string decoded(const std::string& text) {
  std::string bytes;
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '%' && i + 2 < text.size()) {
      bytes += static_cast<char>(std::stoi(text.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      bytes += text[i];
    }
  return bytes;
}

/// The addresses in the browser's log of its network that do not start with `own`.
std::vector<std::string> requests_in(const fs::path& log, const std::string& own) {
  std::ifstream file(log);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  std::vector<std::string> found;
  const std::string key = "\"url\":\"";
  for (std::size_t at = text.find(key); at != std::string::npos; at = text.find(key, at + 1)) {
    const std::size_t begin = at + key.size();
    const std::string address = text.substr(begin, text.find('"', begin) - begin);
    if (!address.starts_with(own)) found.push_back(address);
  }
  return found;
}

std::string with_scripts(std::string html, const std::string& examination) {
  std::string report = kReport;
  const std::string place = "EXAMINATION";
  report.replace(report.find(place), place.size(), examination);
  // The policy comes first, so that it holds for what is added.
  html.insert(html.find("<style>"), kWatch);
  html.insert(html.rfind("</body>"), report);
  return html;
}

}  // namespace

bool Browser::is_here() { return !program().empty(); }

BrowserVisit Browser::visit(const std::string& html, const std::string& examination,
                            const BrowserWindow& window, const fs::path& folder) {
  const fs::path page = folder / "visited.html";
  std::ofstream(page, std::ios::binary) << with_scripts(html, examination);
  return visit_address("file://" + page.string(), "file:", window, 2000, folder);
}

BrowserVisit Browser::visit_address(const std::string& address, const std::string& own,
                                    const BrowserWindow& window, int budget_ms,
                                    const fs::path& folder) {
  const fs::path log = folder / "network.json";
  fs::remove(log);
  // Containers lack what the browser's own sandbox needs.
  const std::string command =
      "timeout 120 " + program() + " --headless --no-sandbox --hide-scrollbars" +
      (window.has_webgl ? " --use-angle=swiftshader --enable-unsafe-swiftshader"
                        : " --disable-gpu --disable-3d-apis") +
      " --disable-dev-shm-usage --user-data-dir=" + shell_word((folder / "browser").string()) +
      " --log-net-log=" + shell_word(log.string()) +
      " --window-size=" + std::to_string(window.width) + ",900" +
      " --blink-settings=preferredColorScheme=" + (window.is_dark ? "0" : "1") +
      " --virtual-time-budget=" + std::to_string(budget_ms) + " --dump-dom " + shell_word(address) +
      " 2>/dev/null";
  const std::string dom = output_of(command), key = "data-visit=\"";
  BrowserVisit visit;
  const std::size_t at = dom.find(key);
  if (at == std::string::npos) {
    visit.complaints.push_back("the page did not finish: " + dom.substr(0, 500));
    return visit;
  }
  const std::size_t begin = at + key.size();
  const auto json = nlohmann::json::parse(decoded(dom.substr(begin, dom.find('"', begin) - begin)));
  visit.report = json["report"];
  visit.complaints = json["complaints"];
  visit.requests = json["requests"];
  for (std::string& request : requests_in(log, own)) visit.requests.push_back(std::move(request));
  return visit;
}

}  // namespace planetree::tools
