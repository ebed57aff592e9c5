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

/// The command line of one verb, declared option by option; each kind of value
/// is read and refused in one way. Values are written while the command line is
/// parsed: what they refer to must live until then. subcommand_options.cpp and
/// command.cpp alone know CLI11, which takes long to compile.
class SubcommandOptions {
 public:
  /// An option that others refer to.
  using Option = CLI::Option*;

  SubcommandOptions(CLI::App& app, const std::string& name, const std::string& help);

  /// A name with dashes is an option, one without is an argument.
  Option path(const std::string& name, const char* type, std::filesystem::path& value,
              const std::string& help);
  Option flag(const std::string& name, bool& value, const std::string& help);

  /// A number of bytes: 4096, 64K, 1.5G.
  Option bytes(const std::string& name, std::uint64_t& value, const std::string& help);
  /// A whole number: 5000, 20K; at most `most`.
  Option count(const std::string& name, std::uint64_t& value, std::uint64_t most,
               const std::string& help);
  /// A length >= 0 in model units; infinite only where `infinite` says so.
  Option length(const std::string& name, double& value, bool infinite, const std::string& help);
  /// One of a few words.
  Option word(const std::string& name, const std::vector<std::string>& words,
              std::function<void(const std::string&)> take, const std::string& help);
  /// Text that `complaint` judges (an empty complaint: it is good) before `take`
  /// reads it.
  Option text(const std::string& name, const char* type,
              std::function<std::string(const std::string&)> complaint,
              std::function<void(const std::string&)> take, const std::string& help);

  static Option require(Option option);
  /// What --help says is taken where nothing is given.
  static Option default_text(Option option, const std::string& text);
  static void need(Option option, Option other);
  static void exclude(Option option, Option other);
  static bool given(Option option);

  /// Called once a person has given the verb and all values are read; may still
  /// complain.
  void on_given(std::function<std::string()> act);

 private:
  CLI::App& subcommand_;
};

}  // namespace planetree::tools
