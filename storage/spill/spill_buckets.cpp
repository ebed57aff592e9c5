#include "storage/spill/spill_buckets.h"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace planetree::storage {
namespace {

// Smaller blocks would cost a disk more time per block than per byte. Larger ones gain nothing.
constexpr std::uint64_t kMinBlockBytes = 256;
constexpr std::uint64_t kMaxBlockBytes = std::uint64_t{256} << 10;

std::size_t block_records(std::size_t record_bytes, std::size_t bucket_count,
                          std::uint64_t buffer_bytes) {
  const std::uint64_t bytes =
      std::clamp(buffer_bytes / bucket_count, kMinBlockBytes, kMaxBlockBytes);
  const std::uint64_t payload = bytes - sizeof(std::uint64_t);
  return static_cast<std::size_t>(std::max<std::uint64_t>(payload / record_bytes, 1));
}

}  // namespace

SpillBuckets::SpillBuckets(std::size_t record_bytes, std::size_t bucket_count,
                           std::uint64_t buffer_bytes, SpillFile& file)
    : record_bytes_(record_bytes),
      block_records_(block_records(record_bytes, bucket_count, buffer_bytes)),
      file_(file),
      buckets_(bucket_count) {
  assert(record_bytes > 0 && bucket_count > 0);
}

bool SpillBuckets::make_space(Bucket& bucket) {
  if (!bucket.records) {
    bucket.records = std::make_unique_for_overwrite<std::byte[]>(block_bytes());
    return true;
  }
  std::memcpy(bucket.records.get() + block_records_ * record_bytes_, &bucket.last_block,
              sizeof bucket.last_block);
  const auto offset = file_.append({bucket.records.get(), block_bytes()});
  if (!offset) {
    failure_ = offset.error();
    return false;
  }
  bucket.last_block = *offset;
  bucket.size = 0;
  return true;
}

// Reads a block into block_. Returns the offset of the block before it, or kNoBlock.
Result<std::uint64_t> SpillBuckets::read_block(std::uint64_t offset) {
  block_.resize(block_bytes());
  if (const auto read = file_.read(offset, block_); !read) return read.error();
  std::uint64_t before = 0;
  std::memcpy(&before, block_.data() + block_records_ * record_bytes_, sizeof before);
  return before;
}

}  // namespace planetree::storage
