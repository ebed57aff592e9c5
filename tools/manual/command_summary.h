#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace planetree::tools {

/// One option or argument of a subcommand.
struct OptionSummary {
  std::vector<std::string> names;    ///< "-o", "--output"; empty for an argument
  std::string value;                 ///< "SIZE", "OUT.ptree"; empty for a flag
  std::vector<std::string> choices;  ///< all values, if they are few words
  bool is_path = false;
  bool is_required = false;
  std::string help;  ///< sentences that also state the default and related options

  /// "-o, --output".
  std::string joined_names() const;
};

/// A command or subcommand, in the order of declaration.
struct CommandSummary {
  std::string name;     ///< "planetree", or "build"
  std::string version;  ///< what --version prints; empty for a subcommand
  std::string description;
  std::vector<OptionSummary> arguments;
  std::vector<OptionSummary> options;
  std::vector<CommandSummary> subcommands;
};

/// Reads the declared command line of a command and its subcommands.
[[nodiscard]] CommandSummary summarize(CLI::App& app);

/// The words of a command line that gives all arguments and the required options: "[options] IN
/// --output OUT.ptree".
[[nodiscard]] std::string usage_of(const CommandSummary& command);

}  // namespace planetree::tools
