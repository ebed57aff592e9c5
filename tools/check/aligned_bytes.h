#pragma once

#include <cstddef>
#include <cstring>
#include <memory>
#include <new>
#include <span>

#include "octree/page/frame.h"

namespace planetree::tools {

/// Bytes aligned to a slot, as frames must be.
class AlignedBytes {
 public:
  /// Allocates `bytes`, a multiple of the slot. The old content is lost.
  void resize(std::size_t bytes) {
    if (bytes == bytes_) return;
    slots_ = std::make_unique<Slot[]>(bytes / sizeof(Slot));
    bytes_ = bytes;
  }
  std::byte* data() { return reinterpret_cast<std::byte*>(slots_.get()); }
  const std::byte* data() const { return reinterpret_cast<const std::byte*>(slots_.get()); }
  std::span<std::byte> span() { return {data(), bytes_}; }

 private:
  struct alignas(octree::kSlotBytes) Slot {
    std::byte bytes[octree::kSlotBytes];
  };
  std::unique_ptr<Slot[]> slots_;
  std::size_t bytes_ = 0;
};

}  // namespace planetree::tools
