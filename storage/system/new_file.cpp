#include "storage/system/new_file.h"

#include <fcntl.h>
#include <stdio.h>  // NOLINT(modernize-deprecated-headers): for renameat2
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <utility>

#include "storage/system/file_error.h"

namespace planetree::storage {
namespace {

constexpr mode_t kMode = 0666;  // the system subtracts the umask
constexpr int kMaxNameAttempts = 100;

Error write_error(const char* what) noexcept { return file_error(errno, FileAction::kWrite, what); }

Error already_exists(const char* cause) noexcept {
  return make_error(ErrorCode::kAlreadyExists, Error::kNowhere, Error::kNowhere, "%s", cause);
}

// Returns a name that is unique among the running processes of this machine. If a file has it
// nevertheless, callers try the next name.
std::string make_temporary_name() {
  static std::atomic<unsigned> counter{0};
  return ".planetree-" + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
}

// Path by which linkat() finds an unnamed file.
std::string descriptor_path(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

Result<void> check_destination(const FileHandle& directory, const std::string& name,
                               bool replace) noexcept {
  struct stat status;
  if (directory.calls().fstatat(directory.descriptor(), name.c_str(), &status,
                                AT_SYMLINK_NOFOLLOW) != 0) {
    if (errno == ENOENT) return {};
    return write_error("examine the destination");
  }
  if (!replace) {
    return already_exists("the destination exists; choose another name or allow replacing it");
  }
  if (!S_ISREG(status.st_mode) && !S_ISLNK(status.st_mode)) {
    return already_exists("the destination is no regular file; choose another name");
  }
  return {};
}

}  // namespace

NewFile::NewFile(NewFile&& other) noexcept
    : directory_(std::move(other.directory_)),
      file_(std::move(other.file_)),
      name_(std::move(other.name_)),
      temporary_name_(std::exchange(other.temporary_name_, {})),
      replace_(other.replace_) {}

NewFile::~NewFile() { discard(); }

Result<NewFile> NewFile::create(const std::filesystem::path& path, bool replace, FileCalls& calls) {
  NewFile created;
  created.name_ = path.filename().string();
  created.replace_ = replace;
  if (created.name_.empty() || created.name_ == "." || created.name_ == "..") {
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "the destination has no file name; add one");
  }
  const std::filesystem::path parent = path.has_parent_path() ? path.parent_path() : ".";
  created.directory_ = FileHandle::open(calls, AT_FDCWD, parent.c_str(), O_RDONLY | O_DIRECTORY);
  if (!created.directory_.is_open()) return write_error("open the destination's directory");
  if (const Result<void> checked = check_destination(created.directory_, created.name_, replace);
      !checked) {
    return checked.error();
  }
  if (const Result<void> opened = created.open_unnamed(); !opened) return opened.error();
  if (!created.file_.is_open()) {
    if (const Result<void> opened = created.open_named(); !opened) return opened.error();
  }
  return created;
}

// Leaves the file closed, without an error, if the system has no unnamed files or no way to name
// them later.
Result<void> NewFile::open_unnamed() noexcept {
  file_ = FileHandle::open(calls(), directory_.descriptor(), ".", O_TMPFILE | O_RDWR, kMode);
  if (!file_.is_open()) {
    const bool unknown = errno == EOPNOTSUPP || errno == EISDIR || errno == EINVAL;
    if (unknown) return {};
    return write_error("create a file in the destination's directory");
  }
  struct stat status;
  const std::string path = descriptor_path(file_.descriptor());
  if (calls().fstatat(AT_FDCWD, path.c_str(), &status, 0) != 0) file_.close();
  return {};
}

Result<void> NewFile::open_named() {
  for (int attempt = 0; attempt < kMaxNameAttempts; ++attempt) {
    std::string name = make_temporary_name();
    file_ = FileHandle::open(calls(), directory_.descriptor(), name.c_str(),
                             O_CREAT | O_EXCL | O_NOFOLLOW | O_RDWR, kMode);
    if (file_.is_open()) {
      temporary_name_ = std::move(name);
      return {};
    }
    if (errno != EEXIST) break;
  }
  return write_error("create a file in the destination's directory");
}

Result<void> NewFile::write_at(std::uint64_t offset,
                               std::span<const std::byte> bytes) const noexcept {
  assert(file_.is_open());
  return file_.write_at(offset, bytes);
}

Result<void> NewFile::commit() {
  assert(file_.is_open());
  // After a failed fsync() a second one may report success for bytes that were lost. So the file is
  // discarded and has to be written again.
  if (calls().fsync(file_.descriptor()) != 0) {
    const Error error = write_error("make the file durable");
    discard();
    return error;
  }
  const Result<void> published = temporary_name_.empty() ? publish_unnamed() : publish_named();
  if (!published) {
    discard();
    return published;
  }
  file_.close();
  return sync_directory();
}

Result<void> NewFile::publish_unnamed() {
  const std::string path = descriptor_path(file_.descriptor());
  if (calls().linkat(AT_FDCWD, path.c_str(), directory_.descriptor(), name_.c_str(),
                     AT_SYMLINK_FOLLOW) == 0) {
    return {};
  }
  if (errno != EEXIST || !replace_) return write_error("give the file its name");
  if (const Result<void> linked = link_under_temporary_name(); !linked) return linked;
  return rename_over_destination();
}

Result<void> NewFile::link_under_temporary_name() {
  const std::string path = descriptor_path(file_.descriptor());
  for (int attempt = 0; attempt < kMaxNameAttempts; ++attempt) {
    std::string name = make_temporary_name();
    if (calls().linkat(AT_FDCWD, path.c_str(), directory_.descriptor(), name.c_str(),
                       AT_SYMLINK_FOLLOW) == 0) {
      temporary_name_ = std::move(name);
      return {};
    }
    if (errno != EEXIST) break;
  }
  return write_error("give the file a temporary name");
}

Result<void> NewFile::publish_named() noexcept {
  if (replace_) return rename_over_destination();
  const int directory = directory_.descriptor();
  if (calls().renameat2(directory, temporary_name_.c_str(), directory, name_.c_str(),
                        RENAME_NOREPLACE) == 0) {
    temporary_name_.clear();
    return {};
  }
  if (errno != EINVAL && errno != ENOSYS) return write_error("give the file its name");
  // Network file systems do not know RENAME_NOREPLACE, but have links. discard() removes the
  // temporary name that remains.
  if (calls().linkat(directory, temporary_name_.c_str(), directory, name_.c_str(), 0) != 0) {
    return write_error("give the file its name");
  }
  return {};
}

Result<void> NewFile::rename_over_destination() noexcept {
  const int directory = directory_.descriptor();
  if (calls().renameat2(directory, temporary_name_.c_str(), directory, name_.c_str(), 0) != 0) {
    return write_error("replace the destination");
  }
  temporary_name_.clear();
  return {};
}

Result<void> NewFile::sync_directory() noexcept {
  discard();
  const int outcome = calls().fsync(directory_.descriptor());
  // Some file systems cannot sync directories and report EINVAL or EROFS.
  if (outcome == 0 || errno == EINVAL || errno == EROFS) return {};
  return file_error(
      errno, FileAction::kWrite,
      "sync the directory (the file is complete under its name, but a power failure may "
      "undo that)");
}

void NewFile::discard() noexcept {
  file_.close();
  if (temporary_name_.empty()) return;
  // A second attempt covers a transient failure, because nothing else removes the file.
  const int directory = directory_.descriptor();
  if (calls().unlinkat(directory, temporary_name_.c_str(), 0) != 0 && errno != ENOENT) {
    calls().unlinkat(directory, temporary_name_.c_str(), 0);
  }
  temporary_name_.clear();
}

}  // namespace planetree::storage
