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

/// Records of one size, distributed over buckets. Each bucket is read by itself. This sorts records
/// with known positions without comparing them: a bucket stands for a range of positions. Records
/// are written once and read once. A block here is a group of records of one bucket that is written
/// together. Memory does not grow with the number of records.
///
/// threads  one at a time.
class SpillBuckets {
 public:
  /// record_bytes  size of a record, at least 1.
  /// bucket_count  at least 1.
  /// buffer_bytes  approximate memory to use, for one block of each bucket.
  /// file          receives full blocks; must outlive this object.
  SpillBuckets(std::size_t record_bytes, std::size_t bucket_count, std::uint64_t buffer_bytes,
               SpillFile& file);

  /// Adds a record and returns its memory, which the caller must fill before the next call. Returns
  /// null if a full block could not be written; failure() then has the error.
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

  /// Calls take(records) with all records of a bucket, one block at a time, the blocks in no
  /// particular order. `take` returns Result<void>; an error ends the loop.
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

  /// The full blocks of a bucket are in the file. Each is followed by the offset of the block
  /// before it, or by kNoBlock.
  struct Bucket {
    std::unique_ptr<std::byte[]> records;  ///< memory of the block being filled
    std::size_t size = 0;                  ///< number of records in that block
    std::uint64_t last_block = kNoBlock;   ///< offset of the last full block
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
  std::vector<std::byte> block_;  ///< the block being read
  std::optional<Error> failure_;
};

}  // namespace planetree::storage
