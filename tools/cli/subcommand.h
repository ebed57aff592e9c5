#pragma once

#include <cstdint>
#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "planetree/error.h"

/// Console, error lines and exit status of all subcommands.
namespace planetree::tools {

/// Exit status of the command.
inline constexpr int kDone = 0;
inline constexpr int kDataAtFault = 1;
inline constexpr int kCommandLineAtFault = 2;
inline constexpr int kMachineAtFault = 3;  ///< space, memory, permission, devices

/// An exit status and its meaning, as help and man pages state it.
struct ExitStatus {
  int status;
  const char* meaning;
};
inline constexpr ExitStatus kExitStatuses[] = {
    {kDone, "done"},
    {kDataAtFault, "the data is at fault"},
    {kCommandLineAtFault, "the command line is at fault"},
    {kMachineAtFault, "the machine is at fault (space, memory, permission)"}};

/// The exit status for an error.
[[nodiscard]] int exit_status(ErrorCode code) noexcept;

/// "planetree: FILE: page 3, at byte 4096: cause; what to do" in one line: control characters, also
/// in the file's name, become '?'. The cause and what to do are those of in_command_words().
[[nodiscard]] std::string error_line(std::string_view file, const Error& error);

/// One line of JSON. Bytes that are not UTF-8, as in file names, are replaced.
[[nodiscard]] std::string json_line(const nlohmann::ordered_json& value);

/// Peak resident memory of this process so far, in bytes.
[[nodiscard]] std::uint64_t peak_resident_bytes();

/// The streams of one run of the command. Standard output may be closed early, as by `| head`: that
/// is no error, and the subcommand stops.
class Console {
 public:
  /// The streams must outlive this. They are not closed.
  Console(std::FILE* input, std::FILE* output, std::FILE* errors)
      : input_(input), output_(output), errors_(errors) {}

  std::FILE* input() const { return input_; }
  std::FILE* output() const { return output_; }
  std::FILE* errors() const { return errors_; }
  bool output_is_terminal() const;

  /// Appends to standard output. Returns false once writing has failed: nothing is written from
  /// then on, and the subcommand should end with finish().
  bool print(std::string_view text);
  /// Writes a report to standard error, for use where standard output carries data.
  void note(std::string_view text);
  /// Writes one warning line to standard error.
  void warn(std::string_view file, std::string_view text);
  /// Writes error_line() to standard error. Returns the exit status.
  int fail(std::string_view file, const Error& error);
  /// Flushes standard output. Returns the greater of `status` and the status of the output.
  int finish(int status);

 private:
  std::FILE* input_;
  std::FILE* output_;
  std::FILE* errors_;
  int output_error_ = 0;  // errno of the first failure
};

}  // namespace planetree::tools
