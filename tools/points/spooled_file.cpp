#include "tools/points/spooled_file.h"

#include <cerrno>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "storage/system/file_error.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

Error spool_error() {
  return storage::file_error(errno, storage::FileAction::kWrite,
                             "copy the points to a temporary file");
}

}  // namespace

Result<octree::MeshFile> spool(InputFile& stream) {
  const std::unique_ptr<std::FILE, Close> copy(std::tmpfile());
  if (copy == nullptr) return spool_error();
  std::vector<std::byte> piece(kPieceBytes);
  for (std::size_t bytes = piece.size(); bytes == piece.size();) {
    const auto read = stream.read(piece);
    if (!read) return read.error();
    bytes = *read;
    if (std::fwrite(piece.data(), 1, bytes, copy.get()) != bytes) return spool_error();
  }
  if (std::fflush(copy.get()) != 0) return spool_error();
  return octree::MeshFile::open("/proc/self/fd/" + std::to_string(fileno(copy.get())));
}

}  // namespace planetree::tools
