#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::storage {

/// What records are ordered by: their first 16 bytes, as two numbers in the machine's order.
struct SpillKey {
  std::uint64_t first = 0;
  std::uint64_t second = 0;

  // clang-tidy takes what the compiler writes here for our 0.
  auto operator<=>(const SpillKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// Sorted runs of records of one size, in memory as far as allowed and in a SpillFile beyond.
/// They are not merged: who wants the records between two keys gets those of every run, and
/// sorts them. So records are written once and read once, and nobody depends on how many
/// runs there are.
///
/// threads  any number may add runs; then any number may cut and read.
class SpillRuns {
 public:
  /// Where a key is in every run.
  using Cut = std::vector<std::uint64_t>;
  /// Where a run is that is not in memory.
  struct Extent {
    std::uint64_t offset = 0;  ///< in the file
    std::uint64_t size = 0;    ///< records
    /// The first halves of the keys of every kMarkRecords-th record: with them one read finds any.
    std::vector<std::uint64_t> marks;
  };
  /// A stretch that is read at once takes little longer than one record of it.
  static constexpr std::uint64_t kMarkRecords = 256;
  static constexpr std::uint64_t mark_count(std::uint64_t records) {
    return (records + kMarkRecords - 1) / kMarkRecords;
  }

  /// record_bytes  at least 16.
  /// held_bytes    of runs may stay in memory.
  /// file          takes the others; must outlive this.
  SpillRuns(std::size_t record_bytes, std::uint64_t held_bytes, SpillFile& file)
      : record_bytes_(record_bytes), held_bytes_(held_bytes), file_(file) {}

  /// Adds a run of whole records, ascending by key. Returns its place, if it is not in memory.
  Result<Extent> add(std::vector<std::byte> records);
  /// Adds a run that is in the file.
  void add_extents(Extent extent);
  /// Of all runs, none of which is in memory.
  std::vector<Extent> extents() const;

  std::uint64_t size() const noexcept { return size_; }
  std::size_t record_bytes() const noexcept { return record_bytes_; }

  Cut begin() const { return Cut(runs_.size(), 0); }
  Cut end() const;
  /// The first records that are not before a key.
  Result<Cut> cut(const SpillKey& key) const;
  /// Records between two cuts; modulo 2^64 where `to` is before `from`.
  static std::uint64_t count(const Cut& from, const Cut& to);

  /// Records between two cuts, run after run.
  Result<std::vector<std::byte>> read(const Cut& from, const Cut& to) const;

 private:
  struct Run {
    Extent extent;                // of which only the size counts where it is
    std::vector<std::byte> held;  // in memory
  };

  Result<void> get(const Run& run, std::uint64_t from, std::span<std::byte> out) const;
  std::vector<std::uint64_t> marks_of(std::span<const std::byte> records) const;
  Result<std::uint64_t> find(const Run& run, const SpillKey& key) const;
  Result<std::uint64_t> find_within(const Run& run, std::uint64_t first, std::uint64_t last,
                                    const SpillKey& key) const;

  const std::size_t record_bytes_;
  std::uint64_t held_bytes_;
  SpillFile& file_;
  std::mutex adding_;
  std::uint64_t size_ = 0;
  std::vector<Run> runs_;
};

}  // namespace planetree::storage
