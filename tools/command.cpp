#include "tools/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <new>
#include <string>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/build.h"
#include "tools/generate.h"
#include "tools/inspect.h"
#include "tools/query.h"
#include "tools/touch.h"
#include "tools/verify.h"

namespace planetree::tools {
namespace {

constexpr const char* kFooter =
    "Sizes take K, M and G. Exit status: 0 done, 1 the data is at fault, 2 the command line is\n"
    "at fault, 3 the machine is at fault (space, memory, permission).";

int refuse(const CLI::App& app, const CLI::ParseError& error, Console& console) {
  std::string cause = error.what();
  std::replace(cause.begin(), cause.end(), '\n', ' ');
  const auto subcommands = app.get_subcommands();
  if (subcommands.empty()) {
    fmt::print(console.errors(), "planetree: {}; see planetree --help\n", cause);
  } else {
    const std::string subcommand = subcommands.front()->get_name();
    fmt::print(console.errors(), "planetree: {}: {}; see planetree {} --help\n", subcommand, cause,
               subcommand);
  }
  return kCommandLineAtFault;
}

/// Prints an error and returns true if there is no argument, or the first one is neither an option
/// nor a subcommand.
bool lacks_subcommand(const CLI::App& app, int argc, const char* const* argv, Console& console) {
  if (argc < 2) {
    fmt::print(console.errors(), "planetree: no subcommand; planetree --help lists them\n");
    return true;
  }
  const std::string first = argv[1];
  const auto subcommands = app.get_subcommands(
      [&first](const CLI::App* subcommand) { return subcommand->get_name() == first; });
  if (first.starts_with('-') || !subcommands.empty()) return false;
  fmt::print(console.errors(), "planetree: no subcommand '{}'; planetree --help lists them\n",
             octree::printable(first));
  return true;
}

int run_action(const std::function<int()>& action, Console& console) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    const Error error = make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                                   "the system gives no more; free some, or lower --memory");
    return console.fail("memory", error);
  }
}

}  // namespace

int run_command(int argc, const char* const* argv, Console& console) {
  CLI::App app("Exact closest-point questions about triangle meshes larger than memory",
               "planetree");
  app.require_subcommand(1);
  app.footer(kFooter);
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  std::function<int()> action;
  add_generate(app, console, action);
  add_build(app, console, action);
  add_query(app, console, action);
  add_inspect(app, console, action);
  add_verify(app, console, action);
  add_touch(app, console, action);
  if (lacks_subcommand(app, argc, argv, console)) return kCommandLineAtFault;
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success&) {
    console.print(app.help());
    return console.finish(kDone);
  } catch (const CLI::ParseError& error) {
    return refuse(app, error, console);
  }
  return run_action(action, console);
}

}  // namespace planetree::tools
