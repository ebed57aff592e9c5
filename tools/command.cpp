#include "tools/command.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "storage/file/file_layout.h"
#include "tools/build/build.h"
#include "tools/build/shard.h"
#include "tools/cli/file_text.h"
#include "tools/compare.h"
#include "tools/generate.h"
#include "tools/inspect.h"
#include "tools/manual/help_text.h"
#include "tools/nearest_word.h"
#include "tools/query.h"
#include "tools/scene.h"
#include "tools/thickness.h"
#include "tools/touch.h"
#include "tools/trade.h"
#include "tools/tune.h"
#include "tools/verify.h"
#include "tools/view.h"

namespace planetree::tools {
namespace {

const std::string kVersion = fmt::format("planetree {} (file format {})", PLANETREE_VERSION,
                                         format_version_text(storage::kFormatVersion));

/// The command line and, once it is parsed, what to do.
struct CommandLine {
  explicit CommandLine(Console& console);

  CLI::App app;
  std::function<int()> action;
};

CommandLine::CommandLine(Console& console)
    : app("Exact closest-point queries on triangle meshes larger than memory", "planetree") {
  app.require_subcommand(1);
  app.set_help_flag("-h,--help", "Show this help");
  app.option_defaults()->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  add_generate(app, console, action);
  add_build(app, console, action);
  add_shard(app, console, action);
  add_query(app, console, action);
  add_compare(app, console, action);
  add_thickness(app, console, action);
  add_inspect(app, console, action);
  add_verify(app, console, action);
  add_scene(app, console, action);
  add_view(app, console, action);
  add_touch(app, console, action);
  add_trade(app, console, action);
  add_tune(app, console, action);
  app.set_version_flag("--version", kVersion, "Show the version");
}

/// What --help shows of the command line so far.
std::string help_for(CLI::App& app) {
  const auto chosen = app.get_subcommands();
  const CommandSummary command = summarize(app);
  return chosen.empty() ? help_text(command) : help_text(command, summarize(*chosen.front()));
}

std::string suggestion(const std::optional<std::string>& word) {
  return word ? fmt::format("; did you mean {}?", *word) : std::string();
}

/// What is wrong with the first option that the subcommand does not have. Empty if there is none.
std::optional<std::string> unknown_option(const CLI::App& subcommand) {
  const auto rest = subcommand.remaining();
  const auto found = std::find_if(rest.begin(), rest.end(), [](const std::string& text) {
    return text.size() > 1 && text.starts_with('-') && text != "--";
  });
  if (found == rest.end()) return std::nullopt;
  const std::string option = found->substr(0, found->find('='));
  std::vector<std::string> names;
  for (const CLI::Option* known : subcommand.get_options())
    for (const std::string& name : known->get_lnames()) names.push_back("--" + name);
  return fmt::format("no option '{}'{}", octree::printable(option),
                     suggestion(nearest_word(option, names)));
}

int refuse(const CLI::App& app, const CLI::ParseError& error, Console& console) {
  std::string cause = error.what();
  std::replace(cause.begin(), cause.end(), '\n', ' ');
  const auto subcommands = app.get_subcommands();
  if (subcommands.empty()) {
    fmt::print(console.errors(), "planetree: {}; see planetree --help\n", cause);
  } else {
    const std::string subcommand = subcommands.front()->get_name();
    // A misspelled option may be the reason why another is missing.
    cause = unknown_option(*subcommands.front()).value_or(cause);
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
  std::vector<std::string> names;
  for (const CLI::App* subcommand : app.get_subcommands(nullptr))
    names.push_back(subcommand->get_name());
  fmt::print(console.errors(), "planetree: no subcommand '{}'{}; planetree --help lists them\n",
             octree::printable(first), suggestion(nearest_word(first, names)));
  return true;
}

int run_action(const std::function<int()>& action, Console& console) {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    const Error error = make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                                   "the system has no more memory; free some, or lower --memory");
    return console.fail("memory", error);
  }
}

}  // namespace

int run_command(int argc, const char* const* argv, Console& console) {
  CommandLine line(console);
  if (lacks_subcommand(line.app, argc, argv, console)) return kCommandLineAtFault;
  try {
    line.app.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    console.print(kVersion + '\n');
    return console.finish(kDone);
  } catch (const CLI::Success&) {
    console.print(help_for(line.app));
    return console.finish(kDone);
  } catch (const CLI::ParseError& error) {
    return refuse(line.app, error, console);
  }
  return run_action(line.action, console);
}

CommandSummary command_summary() {
  Console console(stdin, stdout, stderr);
  CommandLine line(console);
  return summarize(line.app);
}

}  // namespace planetree::tools
