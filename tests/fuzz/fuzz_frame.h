#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>

#include "octree/page/frame.h"

namespace planetree::octree {

/// A frame of exactly `page_bytes` bytes, so that a sanitizer reports any access beyond. It starts
/// with old bytes, as frames in use do.
class Frame {
 public:
  explicit Frame(std::uint32_t page_bytes)
      : page_bytes_(page_bytes),
        bytes_(static_cast<std::byte*>(std::aligned_alloc(kSlotBytes, page_bytes))) {
    if (!bytes_) std::abort();
    std::memset(bytes_, 0xa5, page_bytes);
  }
  ~Frame() { std::free(bytes_); }
  Frame(const Frame&) = delete;
  Frame& operator=(const Frame&) = delete;

  std::span<std::byte> bytes() { return {bytes_, page_bytes_}; }
  /// The header of a distance page.
  const FrameHeader& header() const { return *reinterpret_cast<const FrameHeader*>(bytes_); }

 private:
  std::uint32_t page_bytes_;
  std::byte* bytes_;
};

}  // namespace planetree::octree
