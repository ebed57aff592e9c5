#include "octree/build/mesh_file.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>

namespace planetree::octree {

namespace {

/// Closes on every way out; a mapping outlives its descriptor.
class Descriptor {
 public:
  explicit Descriptor(int number) noexcept : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const noexcept { return number_; }

 private:
  int number_;
};

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
    case ENOMEM:
      return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                        "no address space to map it; raise the process's limit (ulimit -v)");
    default:
      return make_error(ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere,
                        "cannot be opened (%s); check the path and the device",
                        std::strerror(cause));
  }
}

}  // namespace

Result<MeshFile> MeshFile::open(const std::filesystem::path& path, std::uint64_t max_mapped_bytes) {
  // O_NONBLOCK only so that a FIFO without a writer is refused, not waited for.
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number() < 0) return open_error(errno);
  struct stat status = {};
  if (::fstat(file.number(), &status) != 0) return open_error(errno);
  if (!S_ISREG(status.st_mode)) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                      "not a regular file; a mesh is read out of order, so copy it into a file");
  }
  const auto size_bytes = static_cast<std::uint64_t>(status.st_size);
  if (size_bytes == 0) return MeshFile(nullptr, 0, 0);
  if (size_bytes > std::numeric_limits<std::size_t>::max()) return open_error(EFBIG);
  void* const map = ::mmap(nullptr, static_cast<std::size_t>(size_bytes), PROT_READ, MAP_SHARED,
                           file.number(), 0);
  if (map == MAP_FAILED) return open_error(errno);
  return MeshFile(static_cast<const std::byte*>(map), size_bytes, max_mapped_bytes);
}

MeshFile::MeshFile(const std::byte* bytes, std::uint64_t size_bytes, std::uint64_t max_mapped_bytes)
    : bytes_(bytes), size_bytes_(size_bytes) {
  // What fits whole needs no counting.
  if (bytes_ == nullptr || max_mapped_bytes == 0 || size_bytes <= max_mapped_bytes) return;
  max_windows_ = std::max<std::uint64_t>(max_mapped_bytes / kWindowBytes, 1);
  windows_.resize(static_cast<std::size_t>((size_bytes - 1) / kWindowBytes + 1));
  // One fault may map a whole huge page, against which counting windows is blind.
  ::madvise(const_cast<std::byte*>(bytes_), size_bytes_, MADV_NOHUGEPAGE);
}

MeshFile::MeshFile(MeshFile&& other) noexcept
    : bytes_(std::exchange(other.bytes_, nullptr)),
      size_bytes_(std::exchange(other.size_bytes_, 0)),
      max_windows_(std::exchange(other.max_windows_, 0)),
      window_count_(other.window_count_),
      last_window_(other.last_window_),
      windows_(std::move(other.windows_)) {}

MeshFile::~MeshFile() {
  if (bytes_ != nullptr) ::munmap(const_cast<std::byte*>(bytes_), size_bytes_);
}

void MeshFile::enter_window(std::uint64_t window) noexcept {
  last_window_ = window;
  if (window >= windows_.size() || windows_[window]) return;
  if (window_count_ == max_windows_) {
    // Advice only: were it refused, memory would be larger and nothing else.
    ::madvise(const_cast<std::byte*>(bytes_), size_bytes_, MADV_DONTNEED);
    std::fill(windows_.begin(), windows_.end(), false);
    window_count_ = 0;
  }
  windows_[window] = true;
  ++window_count_;
}

}  // namespace planetree::octree
