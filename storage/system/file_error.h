#pragma once

#include <cstdint>

#include "planetree/error.h"

/// What the system's error numbers mean for us.
namespace planetree::storage {

enum class FileAction : std::uint8_t { kRead, kWrite };

/// The Error of a failed system call, for one that names no file: whoever knows the path adds it.
///
/// number  the call's errno.
/// action  whether an unlisted number is kReadFailed or kWriteFailed.
/// what    what was tried, to follow "cannot": "open the file".
[[nodiscard]] Error file_error(int number, FileAction action, const char* what,
                               std::uint64_t page = Error::kNowhere,
                               std::uint64_t offset = Error::kNowhere) noexcept;

}  // namespace planetree::storage
