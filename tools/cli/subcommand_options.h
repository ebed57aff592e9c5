#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace planetree::tools {

/// The command line of one subcommand, declared option by option. Each kind of value is parsed and
/// refused in one way. The references to values must stay valid until the command line is parsed,
/// because parsing writes to them. Only subcommand_options.cpp, command.cpp and command_summary.cpp
/// include CLI11, which takes long to compile.
class SubcommandOptions {
 public:
  /// Name of the validator by which a path is known from other texts. It accepts every text.
  static constexpr const char* kPathCheck = "path";

  /// A handle of an option.
  using Option = CLI::Option*;

  /// Adds a subcommand to the command line.
  SubcommandOptions(CLI::App& app, const std::string& name, const std::string& help);

  /// A path: of a directory if `type` is "DIR". A name with dashes declares an option, one without
  /// an argument.
  Option path(const std::string& name, const char* type, std::filesystem::path& value,
              const std::string& help);
  /// One or more paths. A name without dashes declares arguments.
  Option paths(const std::string& name, const char* type,
               std::vector<std::filesystem::path>& values, const std::string& help);
  /// A flag without a value.
  Option flag(const std::string& name, bool& value, const std::string& help);

  /// A number of bytes: 4096, 64K, 1.5G.
  Option bytes(const std::string& name, std::uint64_t& value, const std::string& help);
  /// A whole number such as 5000 or 20K, at most `most`.
  Option count(const std::string& name, std::uint64_t& value, std::uint64_t most,
               const std::string& help);
  /// Two words: a whole number, at most `most`, and a path that `complaint` checks.
  Option count_and_path(const std::string& name, const char* type, std::uint64_t& value,
                        std::uint64_t most, std::filesystem::path& path,
                        std::function<std::string(const std::string&)> complaint,
                        const std::string& help);
  /// A length >= 0 in model units; it may be infinite if `infinite`.
  Option length(const std::string& name, double& value, bool infinite, const std::string& help);
  /// One of `words`, which is passed to `take`.
  Option word(const std::string& name, const std::vector<std::string>& words,
              std::function<void(const std::string&)> take, const std::string& help);
  /// Text that `complaint` checks before `take` reads it. An empty complaint accepts the text.
  Option text(const std::string& name, const char* type,
              std::function<std::string(const std::string&)> complaint,
              std::function<void(const std::string&)> take, const std::string& help);

  /// Texts that `complaint` checks, one for each time that the option is given.
  Option texts(const std::string& name, const char* type,
               std::function<std::string(const std::string&)> complaint,
               std::vector<std::string>& values, const std::string& help);

  /// Makes an option or argument mandatory.
  static Option require(Option option);
  /// The default that --help shows.
  static Option default_text(Option option, const std::string& text);
  /// Makes `option` valid only together with `other`.
  static void need(Option option, Option other);
  /// Makes `option` invalid together with `other`.
  static void exclude(Option option, Option other);
  /// Whether the command line has the option.
  static bool given(Option option);

  /// Sets the function to call once the subcommand and its values are parsed. It may return a
  /// complaint.
  void on_given(std::function<std::string()> act);

 private:
  CLI::App& subcommand_;
};

}  // namespace planetree::tools
