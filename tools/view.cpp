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
#include "tools/view/scene_source.h"
#include "tools/view/view_server.h"
#include "tools/view/viewed_kind.h"

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

std::unique_ptr<ViewSource> open_model(const ViewArguments& arguments, SceneFailure& failure) {
  const OpenOptions options;
  auto source = ModelSource::open(arguments.file,
                                  arguments.memory_bytes.value_or(options.memory_budget_bytes));
  if (!source) {
    failure = {arguments.file, source.error()};
    return nullptr;
  }
  if (arguments.trace.empty()) return *std::move(source);
  const auto read = (*source)->read_trace(arguments.trace);
  if (read) return *std::move(source);
  failure = {arguments.trace, read.error()};
  return nullptr;
}

std::unique_ptr<ViewSource> open_source(const ViewArguments& arguments, SceneFailure& failure) {
  const auto kind = viewed_kind(arguments.file);
  failure.file = arguments.file;
  if (!kind) {
    failure.error = kind.error();
    return nullptr;
  }
  if (*kind == ViewedKind::kModel) return open_model(arguments, failure);
  if (arguments.trace.empty())
    return SceneSource::open(arguments.file, arguments.memory_bytes, failure);
  failure.error = make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                             "it is a scene, and --trace shows the session of a model; leave "
                             "--trace out, or view the model that was traced");
  return nullptr;
}

}  // namespace

int run_view(const ViewArguments& arguments, Console& console) {
  const EndSignals end;
  SceneFailure failure;
  const std::unique_ptr<ViewSource> source = open_source(arguments, failure);
  if (!source) return console.fail(failure.file.string(), failure.error);
  const auto server = ViewServer::start(arguments.place, embedded_files(), *source);
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
  const auto memory_bytes = std::make_shared<std::uint64_t>(0);
  const auto port = std::make_shared<std::uint64_t>(0);
  SubcommandOptions subcommand(
      app, "view",
      "Show a .ptree file or a scene in the browser, with a point to drag beside the surface");
  subcommand.require(
      subcommand.path("file", "FILE", options->file,
                      "File that planetree build wrote, or scene file: a JSON object that "
                      "format-spec/scene-v1/spec.md specifies"));
  const auto memory = subcommand.default_text(
      subcommand.bytes("--memory", *memory_bytes, "Maximum memory for the model or the scene"),
      "256M, or what the scene file says");
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
                  "Show the session of this trace of the file, a model, which planetree touch or "
                  "query wrote");
  subcommand.flag("--no-open", options->no_open, "Do not open the page in the browser");
  subcommand.flag("--json", options->json, "Report the page's address as one JSON object");
  subcommand.flag("--quiet", options->quiet, "Write nothing but the page's address");
  subcommand.on_given(
      [options, listens, port, memory, memory_bytes, &console, &action]() -> std::string {
        if (listens->size() > ViewPlace::kMaxAddresses)
          return fmt::format("--listen is given more than {} times", ViewPlace::kMaxAddresses);
        if (!listens->empty()) options->place.addresses = *listens;
        if (SubcommandOptions::given(memory)) options->memory_bytes = *memory_bytes;
        options->place.port = static_cast<std::uint16_t>(*port);
        action = [options, &console] { return run_view(*options, console); };
        return {};
      });
}

}  // namespace planetree::tools
