#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::storage {

/// Records of one size dealt out into buckets, each of which is then read by itself: what puts
/// in order what has places known before, without comparing. Records are written once, in
/// blocks of one bucket, and read once; memory does not grow with their number.
///
/// threads  one at a time.
class SpillBuckets {
 public:
  /// record_bytes  at least 1.
  /// bucket_count  at least 1.
  /// buffer_bytes  about what may be in memory: a block of each bucket.
  /// file          takes blocks that are full; must outlive this.
  SpillBuckets(std::size_t record_bytes, std::size_t bucket_count, std::uint64_t buffer_bytes,
               SpillFile& file);

  /// Adds a record, for whoever calls it to fill before the next call. Null: a full block could
  /// not be put away, failure() says why.
  std::byte* add(std::size_t bucket) {
    Bucket& to = buckets_[bucket];
    if (to.size == block_records_ || !to.records)
      if (!make_space(to)) return nullptr;
    return to.records.get() + to.size++ * record_bytes_;
  }
  [[nodiscard]] const Error& failure() const { return *failure_; }

  [[nodiscard]] std::size_t bucket_count() const { return buckets_.size(); }

  [[nodiscard]] bool is_empty(std::size_t bucket) const {
    return buckets_[bucket].size == 0 && buckets_[bucket].last_block == kNoBlock;
  }

  /// Calls take(records), which returns Result<void>, with all records of a bucket, a block at a
  /// time, the blocks in no particular order.
  /// errors  those of SpillFile::read() and `take`.
  template <class Take>
  Result<void> each_block(std::size_t bucket, const Take& take) {
    const Bucket& from = buckets_[bucket];
    if (from.size > 0)
      if (const Result<void> taken = take(records_of(from.records.get(), from.size)); !taken)
        return taken;
    for (std::uint64_t offset = from.last_block; offset != kNoBlock;) {
      const auto before = read_block(offset);
      if (!before) return before.error();
      if (const Result<void> taken = take(records_of(block_.data(), block_records_)); !taken)
        return taken;
      offset = *before;
    }
    return {};
  }

 private:
  static constexpr std::uint64_t kNoBlock = ~std::uint64_t{0};

  /// Full blocks are on disk, each followed by where the one before it is.
  struct Bucket {
    std::unique_ptr<std::byte[]> records;  ///< of the block that is being filled
    std::size_t size = 0;                  ///< of them
    std::uint64_t last_block = kNoBlock;
  };

  [[nodiscard]] std::size_t block_bytes() const {
    return block_records_ * record_bytes_ + sizeof(std::uint64_t);
  }
  [[nodiscard]] std::span<const std::byte> records_of(const std::byte* records,
                                                      std::size_t count) const {
    return {records, count * record_bytes_};
  }
  bool make_space(Bucket& bucket);
  Result<std::uint64_t> read_block(std::uint64_t offset);

  const std::size_t record_bytes_;
  const std::size_t block_records_;
  SpillFile& file_;
  std::vector<Bucket> buckets_;
  std::vector<std::byte> block_;  ///< that is being read
  std::optional<Error> failure_;
};

}  // namespace planetree::storage
