#include "cache/frame_pool.h"

#include <utility>

namespace planetree::cache {

Result<FramePool> FramePool::create(std::uint32_t frame_count, std::uint32_t frame_bytes) noexcept {
  assert(frame_count > 0 && frame_bytes > 0);
  // The product is at most (2^32 - 1) * 2^32, so it cannot wrap.
  Result<PrefaultedMemory> memory =
      PrefaultedMemory::claim(frame_count * stride_bytes(frame_bytes));
  if (!memory) return memory.error();
  return FramePool(*std::move(memory), frame_count, frame_bytes);
}

FramePool::FramePool(PrefaultedMemory memory, std::uint32_t frame_count,
                     std::uint32_t frame_bytes) noexcept
    : memory_(std::move(memory)),
      stride_bytes_(stride_bytes(frame_bytes)),
      frame_count_(frame_count),
      frame_bytes_(frame_bytes) {}

}  // namespace planetree::cache
