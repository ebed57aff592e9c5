#include "octree/builder/mesh/stream/mesh_window.h"

#include <cassert>
#include <cstring>
#include <span>
#include <utility>

namespace planetree::octree {

const std::byte* MeshWindow::fill(std::uint64_t offset, std::uint64_t bytes) {
  assert(offset <= file_.size_bytes() && bytes <= file_.size_bytes() - offset);
  const std::uint64_t wanted =
      std::min(std::max<std::uint64_t>(bytes, window_bytes_), file_.size_bytes() - offset);
  // Bytes of the new window that are in memory already are kept.
  const std::uint64_t kept = offset >= begin_ && offset < end_ ? end_ - offset : 0;
  const std::byte* const from = kept > 0 ? buffer_.get() + (offset - begin_) : nullptr;
  if (wanted > capacity_ || !buffer_) {
    auto larger = std::make_unique_for_overwrite<std::byte[]>(wanted);
    if (kept > 0) std::memcpy(larger.get(), from, kept);
    buffer_ = std::move(larger);
    capacity_ = wanted;
  } else if (kept > 0) {
    std::memmove(buffer_.get(), from, kept);
  }
  begin_ = offset;
  end_ = offset + kept;
  const auto read =
      file_.read(end_, std::span(buffer_.get() + kept, static_cast<std::size_t>(wanted - kept)));
  if (!read) {
    failure_ = read.error();
    return nullptr;
  }
  end_ = offset + wanted;
  return buffer_.get();
}

}  // namespace planetree::octree
