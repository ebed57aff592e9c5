#include "tools/cli/subcommand.h"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <nlohmann/json.hpp>

#include "storage/system/file_error.h"
#include "tools/cli/command_words.h"

namespace planetree::tools {
namespace {

std::string location_text(const Error& error) {
  // Some texts begin with their page.
  const bool has_page =
      error.page != Error::kNowhere && !std::string_view(error.text).starts_with("page ");
  // Those of mesh files begin with their byte or their line.
  const bool has_offset = error.offset != Error::kNowhere &&
                          !std::string_view(error.text).starts_with("byte ") &&
                          !std::string_view(error.text).starts_with("line ");
  if (has_page && has_offset) return fmt::format("page {}, at byte {}: ", error.page, error.offset);
  if (has_page) return fmt::format("page {}: ", error.page);
  if (has_offset) return fmt::format("at byte {}: ", error.offset);
  return {};
}

std::string in_one_line(std::string text) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, '?');
  return text;
}

}  // namespace

int exit_status(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::kBadArgument:
    case ErrorCode::kNotFound:
    case ErrorCode::kAlreadyExists:
    case ErrorCode::kCancelled:
      return kCommandLineAtFault;
    case ErrorCode::kPermission:
    case ErrorCode::kNoSpace:
    case ErrorCode::kNoMemory:
    case ErrorCode::kReadFailed:
    case ErrorCode::kWriteFailed:
      return kMachineAtFault;
    case ErrorCode::kBadInput:
    case ErrorCode::kNotPlanetree:
    case ErrorCode::kUnsupported:
    case ErrorCode::kTruncated:
    case ErrorCode::kDamaged:
      break;
  }
  return kDataAtFault;
}

std::string error_line(std::string_view file, const Error& error) {
  return in_one_line(fmt::format("planetree: {}: {}{}", file, location_text(error),
                                 in_command_words(error.text))) +
         '\n';
}

std::string json_line(const nlohmann::ordered_json& value) {
  return value.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

std::uint64_t peak_resident_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

bool Console::output_is_terminal() const { return isatty(fileno(output_)) == 1; }

bool Console::print(std::string_view text) {
  if (output_error_ != 0) return false;
  errno = 0;
  if (std::fwrite(text.data(), 1, text.size(), output_) == text.size()) return true;
  output_error_ = errno != 0 ? errno : EIO;
  return false;
}

void Console::note(std::string_view text) { std::fwrite(text.data(), 1, text.size(), errors_); }

void Console::warn(std::string_view file, std::string_view text) {
  const std::string line = in_one_line(fmt::format("planetree: warning: {}: {}", file, text));
  fmt::print(errors_, "{}\n", line);
}

int Console::fail(std::string_view file, const Error& error) {
  // Flushes earlier answers, so that they come first where both streams are the same.
  std::fflush(output_);
  const std::string line = error_line(file, error);
  std::fwrite(line.data(), 1, line.size(), errors_);
  return exit_status(error.code);
}

int Console::finish(int status) {
  errno = 0;
  if (output_error_ == 0 && std::fflush(output_) != 0) output_error_ = errno != 0 ? errno : EIO;
  if (output_error_ == 0 || output_error_ == EPIPE) return status;
  const Error error =
      storage::file_error(output_error_, storage::FileAction::kWrite, "write the answer");
  return std::max(status, fail("standard output", error));
}

}  // namespace planetree::tools
