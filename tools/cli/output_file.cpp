#include "tools/cli/output_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

namespace planetree::tools {
namespace {

namespace fs = std::filesystem;

struct Cause {
  ErrorCode code;
  const char* remedy;
};

Cause cause_of(int error_number) {
  switch (error_number) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return {ErrorCode::kNoSpace, "free some space, raise the limit or write elsewhere"};
    case EACCES:
    case EPERM:
    case EROFS:
      return {ErrorCode::kPermission, "choose a folder you may write to"};
    case ENOENT:
    case ENOTDIR:
      return {ErrorCode::kNotFound, "create the folder first"};
    case ENAMETOOLONG:
    case EISDIR:
      return {ErrorCode::kBadArgument, "choose another name"};
    case EEXIST:
      return {ErrorCode::kAlreadyExists, "use --force to replace it, or another name"};
    case ENOMEM:
      return {ErrorCode::kNoMemory, "free some memory"};
    default:
      return {ErrorCode::kWriteFailed, "check the device, or the program that reads from it"};
  }
}

Error system_error(const char* action, int error_number, std::uint64_t offset = Error::kNowhere) {
  const Cause cause = cause_of(error_number);
  return make_error(cause.code, Error::kNowhere, offset, "cannot %s: %s; %s", action,
                    std::generic_category().message(error_number).c_str(), cause.remedy);
}

/// The mode of the existing file of this name, with links followed; 0 if there is none.
Result<mode_t> existing_mode(const fs::path& path) {
  struct stat status {};
  if (::stat(path.c_str(), &status) == 0) return status.st_mode;
  if (errno == ENOENT) return mode_t{0};
  return system_error("examine the destination", errno);
}

/// The name by which the system knows an open file that may have no other.
std::string descriptor_path(int descriptor) { return fmt::format("/proc/self/fd/{}", descriptor); }

}  // namespace

Result<void> check_is_no_input(const fs::path& output, std::span<const fs::path> inputs) {
  std::error_code none;
  for (const fs::path& input : inputs)
    if (output != "-" && !input.empty() && input != "-" && fs::equivalent(input, output, none))
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "this is an input itself; name another output");
  return {};
}

Result<OutputFile> OutputFile::create(const fs::path& path, bool may_replace) {
  OutputFile file;
  file.may_replace_ = may_replace;
  if (path == "-") {
    file.descriptor_ = STDOUT_FILENO;
    return file;
  }
  const auto mode = existing_mode(path);
  if (!mode) return mode.error();
  if (S_ISDIR(*mode)) return system_error("write", EISDIR);
  if (*mode != 0 && !S_ISREG(*mode)) {
    file.descriptor_ = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (file.descriptor_ < 0) return system_error("open", errno);
    file.owns_descriptor_ = true;
    return file;
  }
  if (*mode != 0 && !may_replace) return system_error("write", EEXIST);
  // Replaces the file that a link points to and keeps the link.
  std::error_code ignored;
  file.destination_ = *mode != 0 ? fs::canonical(path, ignored) : path;
  if (file.destination_.empty()) file.destination_ = path;
  if (const auto opened = file.open_temporary(); !opened) return opened.error();
  return file;
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)),
      owns_descriptor_(std::exchange(other.owns_descriptor_, false)),
      may_replace_(other.may_replace_),
      destination_(std::move(other.destination_)),
      temporary_(std::exchange(other.temporary_, {})),
      bytes_written_(other.bytes_written_) {}

OutputFile::~OutputFile() {
  if (owns_descriptor_) ::close(descriptor_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

// A file without a name vanishes with the process. Not every file system has them, and without
// /proc they cannot be given a name.
Result<void> OutputFile::open_temporary() {
  const fs::path folder = destination_.has_parent_path() ? destination_.parent_path() : ".";
  descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666);
  owns_descriptor_ = descriptor_ >= 0;
  if (owns_descriptor_ && ::access(descriptor_path(descriptor_).c_str(), F_OK) == 0) return {};
  if (owns_descriptor_) ::close(descriptor_);
  owns_descriptor_ = false;
  return with_temporary_name([&](const fs::path& name) {
    descriptor_ = ::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    owns_descriptor_ = descriptor_ >= 0;
    return owns_descriptor_;
  });
}

template <class Create>
Result<void> OutputFile::with_temporary_name(const Create& create) {
  constexpr int kMaxAttempts = 1000;
  const fs::path folder = destination_.parent_path();
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    // The destination's name is not part of this name, because it may have the maximum length.
    const fs::path name = folder / fmt::format(".planetree-{}-{}.part", ::getpid(), attempt);
    if (create(name)) {
      temporary_ = name;
      return {};
    }
    if (errno != EEXIST) return system_error("create a file in that folder", errno);
  }
  return make_error(ErrorCode::kAlreadyExists, Error::kNowhere, Error::kNowhere,
                    "the folder is full of temporary files; remove .planetree-*.part there");
}

Result<void> OutputFile::reserve(std::uint64_t bytes) {
  if (destination_.empty() || bytes == 0) return {};
  const auto length = static_cast<off_t>(std::min<std::uint64_t>(bytes, INT64_MAX));
  if (::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, 0, length) == 0) return {};
  if (cause_of(errno).code != ErrorCode::kNoSpace) return {};
  return make_error(ErrorCode::kNoSpace, Error::kNowhere, Error::kNowhere,
                    "no space for the %llu bytes of this file: %s; %s",
                    static_cast<unsigned long long>(bytes),
                    std::generic_category().message(errno).c_str(), cause_of(errno).remedy);
}

Result<void> OutputFile::write(std::span<const std::byte> bytes) {
  assert(descriptor_ >= 0);
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return system_error("write", errno, bytes_written_);
    bytes_written_ += static_cast<std::uint64_t>(written);
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
  return {};
}

Result<void> OutputFile::rewrite_front(std::span<const std::byte> bytes) {
  assert(can_rewrite() && bytes.size() <= bytes_written_);
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t written =
        ::pwrite(descriptor_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(done));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return system_error("write", errno, done);
    done += static_cast<std::size_t>(written);
  }
  return {};
}

Result<void> OutputFile::commit() {
  if (!owns_descriptor_) return {};
  // Some devices report a lack of space only now.
  if (!destination_.empty() && ::fsync(descriptor_) != 0) return system_error("write", errno);
  if (!destination_.empty() && temporary_.empty()) {
    if (const auto linked = link_unnamed(); !linked) return linked;
  }
  owns_descriptor_ = false;
  if (::close(std::exchange(descriptor_, -1)) != 0) return system_error("write", errno);
  return temporary_.empty() ? Result<void>{} : rename_temporary();
}

// Gives the unnamed file its name, or a temporary one if it is to replace a file.
Result<void> OutputFile::link_unnamed() {
  const std::string file = descriptor_path(descriptor_);
  const auto link = [&](const fs::path& name) {
    return ::linkat(AT_FDCWD, file.c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0;
  };
  if (link(destination_)) return {};
  if (errno != EEXIST || !may_replace_) return system_error("name the finished file", errno);
  return with_temporary_name(link);
}

Result<void> OutputFile::rename_temporary() {
  const unsigned flags = may_replace_ ? 0U : unsigned{RENAME_NOREPLACE};
  int failed = ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, destination_.c_str(), flags);
  // Not every file system supports RENAME_NOREPLACE. create() has checked before.
  if (failed != 0 && (errno == EINVAL || errno == ENOSYS)) {
    failed = ::rename(temporary_.c_str(), destination_.c_str());
  }
  if (failed != 0) return system_error("rename the finished file", errno);
  temporary_.clear();
  return {};
}

}  // namespace planetree::tools
