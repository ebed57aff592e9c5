#include "storage/system/file_error.h"

#include <cerrno>
#include <cstring>

namespace planetree::storage {
namespace {

ErrorCode code_of(int number, FileAction action) noexcept {
  switch (number) {
    case ENOENT:
      return ErrorCode::kNotFound;
    case EEXIST:
      return ErrorCode::kAlreadyExists;
    case EACCES:
    case EPERM:
    case EROFS:
      return ErrorCode::kPermission;
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return ErrorCode::kNoSpace;
    case ENOMEM:
      return ErrorCode::kNoMemory;
    default:
      return action == FileAction::kRead ? ErrorCode::kReadFailed : ErrorCode::kWriteFailed;
  }
}

const char* remedy_of(int number) noexcept {
  switch (number) {
    case ENOENT:
    case ENOTDIR:
    case EISDIR:
    case ELOOP:
    case ENAMETOOLONG:
      return "check the path";
    case EEXIST:
      return "choose another name or allow replacing it";
    case EACCES:
    case EPERM:
      return "check its owner and permissions";
    case EROFS:
      return "choose a directory that can be written";
    case ENOSPC:
      return "free some space or choose another device";
    case EDQUOT:
      return "free some of your quota or choose another device";
    case EFBIG:
      return "raise the limit of file sizes or choose another device";
    case ENOMEM:
      return "free some memory";
    case EMFILE:
    case ENFILE:
      return "close some files or raise the limit of open files";
    default:
      return "check the device and the system's log";
  }
}

}  // namespace

Error file_error(int number, FileAction action, const char* what, std::uint64_t page,
                 std::uint64_t offset) noexcept {
  // Unlike strerror(), strerrordesc_np() neither depends on the locale nor shares a buffer between
  // threads.
  const char* cause = strerrordesc_np(number);
  return make_error(code_of(number, action), page, offset, "cannot %s: %s; %s", what,
                    cause != nullptr ? cause : "unknown system error", remedy_of(number));
}

}  // namespace planetree::storage
