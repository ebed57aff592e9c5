#pragma once

#include <cstdint>
#include <cstdio>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "planetree/error.h"

/// What all verbs of the command share: how they speak and how they end.
namespace planetree::tools {

/// How the command ends, as scripts see it.
inline constexpr int kDone = 0;
inline constexpr int kDataAtFault = 1;
inline constexpr int kCommandLineAtFault = 2;
inline constexpr int kMachineAtFault = 3;

[[nodiscard]] int exit_status(ErrorCode code) noexcept;

/// "planetree: FILE: page 3, at byte 4096: cause; what to do", in one line
/// whatever the file's name holds.
[[nodiscard]] std::string error_line(std::string_view file, const Error& error);

/// One line of JSON. Text that is not UTF-8, as file names may be, is mended.
[[nodiscard]] std::string json_line(const nlohmann::ordered_json& value);

/// Most memory this process has had so far.
[[nodiscard]] std::uint64_t peak_resident_bytes();

/// The streams of one run of the command. Standard output may end early, as in
/// `| head`: a closed pipe is no error, the verb just stops.
class Console {
 public:
  /// The streams must outlive this; they are not closed.
  Console(std::FILE* input, std::FILE* output, std::FILE* errors)
      : input_(input), output_(output), errors_(errors) {}

  std::FILE* input() const { return input_; }
  std::FILE* output() const { return output_; }
  std::FILE* errors() const { return errors_; }
  bool output_is_terminal() const;

  /// Appends to standard output. False once it takes no more: nothing is
  /// written from then on, and a verb should end with finish().
  bool print(std::string_view text);
  /// A report on standard error, where standard output carries data.
  void note(std::string_view text);
  /// One line on standard error.
  void warn(std::string_view file, std::string_view text);
  /// Writes error_line() to standard error; returns the exit status.
  int fail(std::string_view file, const Error& error);
  /// Flushes standard output. Returns `status`, or what became of the output
  /// if that is worse.
  int finish(int status);

 private:
  std::FILE* input_;
  std::FILE* output_;
  std::FILE* errors_;
  int output_error_ = 0;  // errno of the first failure
};

}  // namespace planetree::tools
