#include "octree/builder/mesh/stream/mesh_file.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cinttypes>
#include <cstring>
#include <utility>

#include "octree/builder/mesh/stream/mesh_scratch.h"

namespace planetree::octree {

namespace {

Error open_error(int cause) {
  switch (cause) {
    case ENOENT:
    case ENOTDIR:
      return make_error(ErrorCode::kNotFound, Error::kNowhere, Error::kNowhere,
                        "no such file; check the path");
    case EACCES:
    case EPERM:
      return make_error(ErrorCode::kPermission, Error::kNowhere, Error::kNowhere,
                        "may not be read; check its permissions");
    default:
      return make_error(ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere,
                        "cannot be opened (%s); check the path and the device",
                        std::strerror(cause));
  }
}

}  // namespace

MeshFile::MeshFile(storage::FileHandle file, std::uint64_t size_bytes)
    : file_(std::move(file)), size_bytes_(size_bytes) {}
MeshFile::MeshFile(std::unique_ptr<ScratchFile> content, std::uint64_t size_bytes)
    : content_(std::move(content)), size_bytes_(size_bytes) {}
MeshFile::MeshFile(MeshFile&& other) noexcept = default;
MeshFile& MeshFile::operator=(MeshFile&& other) noexcept = default;
MeshFile::~MeshFile() = default;

Result<MeshFile> MeshFile::open(const std::filesystem::path& path, storage::FileCalls& calls) {
  // With O_NONBLOCK a FIFO without a writer is refused instead of waited for.
  auto file = storage::FileHandle::open(calls, AT_FDCWD, path.c_str(), O_RDONLY | O_NONBLOCK);
  if (!file.is_open()) return open_error(errno);
  struct stat status = {};
  if (calls.fstat(file.descriptor(), &status) != 0) return open_error(errno);
  if (!S_ISREG(status.st_mode)) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "not a regular file; a mesh is read out of order, so copy it into a file");
  }
  return MeshFile(std::move(file), static_cast<std::uint64_t>(status.st_size));
}

Result<void> MeshFile::read(std::uint64_t offset, std::span<std::byte> out) const {
  assert(offset <= size_bytes_ && out.size() <= size_bytes_ - offset);
  if (content_) return content_->spill().read(offset, out);
  const auto read = file_.read_at(offset, out, "read the mesh");
  if (read || read.error().code != ErrorCode::kTruncated) return read;
  return make_error(ErrorCode::kBadInput, Error::kNowhere, read.error().offset,
                    "byte %" PRIu64
                    ": the mesh became shorter while it was read; leave it alone, or copy it "
                    "again, and try once more",
                    read.error().offset);
}

Result<std::string> MeshFile::prefix(std::uint64_t bytes) const {
  std::string text(static_cast<std::size_t>(std::min(bytes, size_bytes_)), '\0');
  if (const auto read = this->read(0, std::as_writable_bytes(std::span(text))); !read)
    return read.error();
  return text;
}

}  // namespace planetree::octree
