#include "tools/view.h"

#include <fmt/format.h>
#include <pthread.h>

#include <csignal>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "tools/cli/subcommand_options.h"
#include "tools/view/browser_start.h"
#include "tools/view/embedded_files.h"
#include "tools/view/model_source.h"
#include "tools/view/numeric_address.h"
#include "tools/view/view_server.h"

namespace planetree::tools {
namespace {

/// The signals that end a session. They are blocked in this thread, and in the threads that it
/// starts, so that wait() gets them.
class EndSignals {
 public:
  EndSignals() {
    ::sigemptyset(&signals_);
    ::sigaddset(&signals_, SIGINT);
    ::sigaddset(&signals_, SIGTERM);
    ::pthread_sigmask(SIG_BLOCK, &signals_, &before_);
  }
  ~EndSignals() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  void wait() const {
    int signal = 0;
    while (::sigwait(&signals_, &signal) != 0) {
    }
  }

 private:
  sigset_t signals_{};
  sigset_t before_{};
};

/// Whether the program was built with three.js.
bool has_picture() {
  for (const PageFile& file : embedded_files())
    if (file.name == "three.module.js") return true;
  return false;
}

void tell(const ViewArguments& arguments, const ViewServer& server, Console& console) {
  if (arguments.json) {
    console.print(json_line({{"file", arguments.file.string()},
                             {"port", server.port()},
                             {"pages", server.pages()},
                             {"picture", has_picture()}}));
  } else {
    for (const std::string& page : server.pages()) console.print(page + "\n");
  }
  console.finish(kDone);
  if (!has_picture() && !arguments.quiet)
    console.warn("view",
                 "built without three.js, so that the page has no picture; docs/view.md "
                 "says how to add it");
  if (!arguments.json && !arguments.quiet)
    console.note("Open this address in a browser of this machine. Ctrl-C ends the session.\n");
}

}  // namespace

int run_view(const ViewArguments& arguments, Console& console) {
  const EndSignals end;
  const auto source = ModelSource::open(arguments.file, arguments.memory_bytes);
  if (!source) return console.fail(arguments.file.string(), source.error());
  if (!arguments.trace.empty())
    if (const auto read = (*source)->read_trace(arguments.trace); !read)
      return console.fail(arguments.trace.string(), read.error());
  const auto server = ViewServer::start(arguments.place, embedded_files(), **source);
  if (!server) return console.fail("view", server.error());
  tell(arguments, **server, console);
  if (!arguments.no_open && is_loopback_address(arguments.place.addresses.front()))
    start_browser((*server)->pages().front());
  end.wait();
  return console.finish(kDone);
}

void add_view(CLI::App& app, Console& console, std::function<int()>& action) {
  const auto options = std::make_shared<ViewArguments>();
  const auto listens = std::make_shared<std::vector<std::string>>();
  const auto port = std::make_shared<std::uint64_t>(0);
  SubcommandOptions subcommand(
      app, "view", "Show a .ptree file in the browser, with a point to drag beside the surface");
  subcommand.require(
      subcommand.path("file", "FILE", options->file, "File that planetree build wrote"));
  subcommand.default_text(
      subcommand.bytes("--memory", options->memory_bytes, "Maximum memory for the model"), "256M");
  subcommand.default_text(
      subcommand.count("--port", *port, 65535, "Port of the page; 0: one that is free"), "0");
  const auto complaint = [](const std::string& text) {
    return is_numeric_address(text) ? std::string()
                                    : "not an address in numbers, such as 127.0.0.1 or ::1";
  };
  subcommand.default_text(
      subcommand.texts("--listen", "ADDRESS", complaint, *listens,
                       "Serve the page at this address of the machine; may be repeated. Others "
                       "who know the page's address can then see the model"),
      "127.0.0.1");
  subcommand.path("--trace", "TRACE", options->trace,
                  "Show the session of this trace of the file, which planetree touch or query "
                  "wrote");
  subcommand.flag("--no-open", options->no_open, "Do not open the page in the browser");
  subcommand.flag("--json", options->json, "Report the page's address as one JSON object");
  subcommand.flag("--quiet", options->quiet, "Write nothing but the page's address");
  subcommand.on_given([options, listens, port, &console, &action]() -> std::string {
    if (listens->size() > ViewPlace::kMaxAddresses)
      return fmt::format("--listen is given more than {} times", ViewPlace::kMaxAddresses);
    if (!listens->empty()) options->place.addresses = *listens;
    options->place.port = static_cast<std::uint16_t>(*port);
    action = [options, &console] { return run_view(*options, console); };
    return {};
  });
}

}  // namespace planetree::tools
