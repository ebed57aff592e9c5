#pragma once

#include <cstdint>

#include "planetree/error.h"

/// Error numbers of the system as planetree errors.
namespace planetree::storage {

enum class FileAction : std::uint8_t { kRead, kWrite };

/// Makes the Error of a failed system call: its cause and a remedy. The text does not name the
/// file; callers that know the path add it.
///
/// number  errno after the call.
/// action  whether a number without a code of its own becomes kReadFailed or kWriteFailed.
/// what    the action that failed, worded to follow "cannot", such as "open the file".
/// page    page number, if the action concerned one.
/// offset  byte offset in the file, if known.
[[nodiscard]] Error file_error(int number, FileAction action, const char* what,
                               std::uint64_t page = Error::kNowhere,
                               std::uint64_t offset = Error::kNowhere) noexcept;

}  // namespace planetree::storage
