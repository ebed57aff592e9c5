#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

#include "planetree/error.h"
#include "tools/cli/output_file.h"
#include "tools/cli/subcommand.h"

namespace planetree::tools {

/// Where answers go: standard output, or a file that appears only when it is complete.
class AnswerOutput {
 public:
  /// path         "-" is standard output
  /// may_replace  whether an existing file may be replaced
  /// errors       those of OutputFile::create()
  static Result<AnswerOutput> open(const std::filesystem::path& path, bool may_replace,
                                   Console& console);

  /// Appends text. False once standard output takes no more, which Console::finish() reports.
  ///
  /// errors  those of OutputFile::write()
  Result<bool> write(std::string_view text);
  /// Gives the file its name. The last call.
  ///
  /// errors  those of OutputFile::commit()
  Result<void> commit();

 private:
  explicit AnswerOutput(Console& console) : console_(&console) {}

  Console* console_;
  std::optional<OutputFile> file_;
};

}  // namespace planetree::tools
