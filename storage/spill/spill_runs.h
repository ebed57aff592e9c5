#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::storage {

/// Sort key of a record: its first 16 bytes, as two numbers in the machine's byte order.
struct SpillKey {
  std::uint64_t first = 0;
  std::uint64_t second = 0;

  // clang-tidy reports a 0 that the compiler generates here.
  auto operator<=>(const SpillKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

/// How records are kept in a file.
enum class Packing : bool {
  kNone,   ///< as they are
  kGroups  ///< compressed, which takes time when they are added and when they are read
};

/// Sorted runs of records of one size, in memory up to a limit, then in a SpillFile. The runs are
/// not merged. read() returns the records between two keys from every run, and the caller sorts
/// them. So records are written once and read once, whatever the number of runs.
///
/// threads  any number may add runs; afterwards any number may search and read them.
class SpillRuns {
 public:
  /// Index of a record in each run.
  using Cut = std::vector<std::uint64_t>;
  /// Position of a run in the file.
  struct Extent {
    std::uint64_t offset = 0;  ///< byte offset in the file
    std::uint64_t size = 0;    ///< number of records
    /// First half of the key of every kMarkRecords-th record. With these, one read usually finds
    /// any key.
    std::vector<std::uint64_t> marks;
    /// Ends of the groups of kMarkRecords records, in bytes from `offset` on; empty: the records
    /// are not packed.
    std::vector<std::uint64_t> group_ends;
  };
  /// To read this many records takes little longer than to read one.
  static constexpr std::uint64_t kMarkRecords = 256;
  static constexpr std::uint64_t mark_count(std::uint64_t records) {
    return (records + kMarkRecords - 1) / kMarkRecords;
  }

  /// record_bytes  size of a record, at least 16.
  /// held_bytes    maximum total size of the runs kept in memory.
  /// file          receives the other runs; must outlive this object.
  /// packing       of the runs that add() writes to the file.
  SpillRuns(std::size_t record_bytes, std::uint64_t held_bytes, SpillFile& file,
            Packing packing = Packing::kNone)
      : record_bytes_(record_bytes), held_bytes_(held_bytes), file_(file), packing_(packing) {}

  /// Adds a run of whole records, ascending by key. Returns its position in the file; of a run kept
  /// in memory only the size is set.
  /// errors  those of SpillFile::append().
  Result<Extent> add(std::vector<std::byte> records);
  /// Adds a run that is in the file already, packed or not.
  void add_extent(Extent extent);
  /// Positions of all runs. None of them may be in memory.
  std::vector<Extent> extents() const;

  std::uint64_t size() const noexcept { return size_; }
  std::size_t record_bytes() const noexcept { return record_bytes_; }

  Cut begin() const { return Cut(runs_.size(), 0); }
  Cut end() const;
  /// Index in each run of the first record whose key is not less than `key`.
  /// errors  those of SpillFile::read().
  Result<Cut> cut(const SpillKey& key) const;
  /// Number of records from `from` up to, but not including, `to`; modulo 2^64 if `to` is before
  /// `from`.
  static std::uint64_t count(const Cut& from, const Cut& to);

  /// Reads the records from `from` up to, but not including, `to`, run after run.
  /// errors  those of SpillFile::read(); kDamaged.
  Result<std::vector<std::byte>> read(const Cut& from, const Cut& to) const;

 private:
  struct Run {
    Extent extent;                // only the size is set if the records are in `held`
    std::vector<std::byte> held;  // the records if they are in memory, otherwise empty
  };

  Result<void> write(std::vector<std::byte> records, Extent& extent);
  void pack(std::vector<std::byte>& records, Extent& extent) const;
  Result<void> get(const Run& run, std::uint64_t from, std::span<std::byte> out) const;
  Result<void> get_packed(const Extent& extent, std::uint64_t from, std::span<std::byte> out) const;
  std::vector<std::uint64_t> marks_of(std::span<const std::byte> records) const;
  Result<std::uint64_t> find(const Run& run, const SpillKey& key) const;
  Result<std::uint64_t> find_within(const Run& run, std::uint64_t first, std::uint64_t last,
                                    const SpillKey& key) const;

  const std::size_t record_bytes_;
  std::uint64_t held_bytes_;
  SpillFile& file_;
  const Packing packing_;
  std::mutex adding_;
  std::uint64_t size_ = 0;
  std::vector<Run> runs_;
};

}  // namespace planetree::storage
