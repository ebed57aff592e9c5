#include "octree/builder/mesh/stream/vertex_cache.h"

#include <algorithm>
#include <span>

namespace planetree::octree {
namespace {

// A call of the system and the seek of a disk are worth a block of about this size. Where memory is
// too small for enough such blocks, blocks are smaller.
constexpr std::uint64_t kBlockBytes = std::uint64_t{16} << 10;
constexpr std::uint64_t kBlocks = 64;

}  // namespace

VertexCache::VertexCache(MeshRecords& vertices, std::uint64_t memory_bytes)
    : vertices_(vertices), record_bytes_(vertices.record_bytes()) {
  const std::uint64_t block_vertices =
      std::min(kBlockBytes, memory_bytes / kBlocks) / record_bytes_;
  block_shift_ = static_cast<int>(std::bit_width(std::max<std::uint64_t>(block_vertices, 1))) - 1;
  const std::uint64_t space = memory_bytes / (block_bytes() + sizeof(Slot));
  const std::uint64_t blocks = (vertices.count() >> block_shift_) + 1;
  if (blocks > space) ways_ = kWays;
  slots_.resize(static_cast<std::size_t>(
      blocks > space ? std::max<std::uint64_t>(space / kWays, 1) * kWays : blocks));
  known_.fill(slots_.data());
}

bool VertexCache::enter(std::uint64_t block, Slot*& slot) {
  Slot* const set = &slots_[static_cast<std::size_t>(block % (slots_.size() / ways_)) * ways_];
  slot = set;
  for (Slot* other = set; other != set + ways_; ++other) {
    if (other->block == block) {
      slot = other;
      return true;
    }
    if (other->used < slot->used) slot = other;
  }
  return load(block, *slot);
}

bool VertexCache::load(std::uint64_t block, Slot& slot) {
  if (!slot.records)
    slot.records =
        std::make_unique_for_overwrite<std::byte[]>(static_cast<std::size_t>(block_bytes()));
  // The old content is lost, whether the new block can be read or not.
  slot.block = kNone;
  const std::uint64_t first = block << block_shift_;
  const std::uint64_t count = std::min(std::uint64_t{1} << block_shift_, vertices_.count() - first);
  const std::span<std::byte> out(slot.records.get(),
                                 static_cast<std::size_t>(count * record_bytes_));
  if (const auto read = vertices_.read(first, out); !read) {
    failure_ = read.error();
    return false;
  }
  read_bytes_ += out.size();
  slot.block = block;
  return true;
}

}  // namespace planetree::octree
