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
  /// Whether rewrite_front() is possible: the answers go to a file, not to a pipe or a device.
  [[nodiscard]] bool can_rewrite() const { return file_ && file_->can_rewrite(); }
  /// Writes text over the first text that was written. Requires can_rewrite().
  ///
  /// errors  those of OutputFile::rewrite_front()
  Result<void> rewrite_front(std::string_view text);
  /// A folder for temporary files: that of the file, or the system's.
  [[nodiscard]] std::filesystem::path temporary_folder() const;
  /// Gives the file its name. The last call.
  ///
  /// errors  those of OutputFile::commit()
  Result<void> commit();

 private:
  explicit AnswerOutput(Console& console) : console_(&console) {}

  Console* console_;
  std::filesystem::path folder_;  // of the file
  std::optional<OutputFile> file_;
};

}  // namespace planetree::tools
