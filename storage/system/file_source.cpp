#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <new>
#include <utility>

#include "storage/system/byte_source.h"
#include "storage/system/file_error.h"
#include "storage/system/mapping.h"

namespace planetree::storage {
namespace {

class FileSource final : public ByteSource {
 public:
  FileSource(FileHandle file, std::uint64_t size_bytes) noexcept
      : file_(std::move(file)), size_bytes_(size_bytes) {}

  std::uint64_t size_bytes() const noexcept override { return size_bytes_; }
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out,
                       const char* what) const noexcept override {
    return file_.read_at(offset, out, what);
  }
  bool try_read(std::uint64_t offset, std::span<std::byte> out,
                const ReadLimits& terms) const noexcept override {
    return file_.try_read(offset, out, terms);
  }
  Result<void> read_early(std::uint64_t offset, std::span<std::byte> out) const noexcept override {
    return copy_mapped(file_, offset, out);
  }

 private:
  const FileHandle file_;
  const std::uint64_t size_bytes_;
};

Result<std::uint64_t> length_of(const FileHandle& file) noexcept {
  struct stat status;
  if (file.calls().fstat(file.descriptor(), &status) != 0) {
    return file_error(errno, FileAction::kRead, "examine the file");
  }
  if (!S_ISREG(status.st_mode)) {
    return make_error(ErrorCode::kNotPlanetree, Error::kNowhere, Error::kNowhere,
                      "this is not a .ptree file but a %s; name a regular file",
                      S_ISDIR(status.st_mode) ? "directory" : "device, pipe or socket");
  }
  return static_cast<std::uint64_t>(status.st_size);
}

}  // namespace

Result<std::unique_ptr<ByteSource>> open_file_source(const char* path, FileCalls& calls) noexcept {
  // O_NONBLOCK: opening a pipe without a writer must not block.
  FileHandle file = FileHandle::open(calls, AT_FDCWD, path, O_RDONLY | O_NONBLOCK | O_NOCTTY);
  if (!file.is_open()) return file_error(errno, FileAction::kRead, "open the file");
  const Result<std::uint64_t> bytes = length_of(file);
  if (!bytes) return bytes.error();
  std::unique_ptr<ByteSource> source(new (std::nothrow) FileSource(std::move(file), *bytes));
  if (!source) return file_error(ENOMEM, FileAction::kRead, "open the file");
  return source;
}

}  // namespace planetree::storage
