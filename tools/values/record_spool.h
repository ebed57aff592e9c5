#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "storage/spill/spill_file.h"

namespace planetree::tools {

/// Records that wait in a temporary file without a name. They are appended and read in pieces, so
/// that memory does not grow with their number.
template <class Record>
class RecordSpool {
 public:
  /// directory  of the file
  explicit RecordSpool(const std::filesystem::path& directory) : file_(directory, kHeldBytes) {}

  /// errors  those of temporary files
  Result<void> add(const Record& record) {
    piece_.push_back(record);
    ++count_;
    return piece_.size() < kPieceRecords ? Result<void>() : flush();
  }
  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// Calls take(span of records), which returns Result<void>, for all records in their order.
  ///
  /// errors  those of temporary files and of `take`
  template <class Take>
  Result<void> for_each_piece(const Take& take) {
    if (const auto flushed = flush(); !flushed) return flushed;
    std::vector<Record> records;
    for (std::uint64_t first = 0; first < count_; first += records.size()) {
      records.resize(std::min<std::uint64_t>(kPieceRecords, count_ - first));
      const auto read =
          file_.read(first * sizeof(Record), std::as_writable_bytes(std::span(records)));
      if (!read) return read;
      if (const auto taken = take(std::span<const Record>(records)); !taken) return taken;
    }
    return {};
  }

 private:
  static constexpr std::size_t kPieceRecords = 32768;
  static constexpr std::uint64_t kHeldBytes = std::uint64_t{1} << 20;

  Result<void> flush() {
    const auto appended = file_.append(std::as_bytes(std::span(piece_)));
    piece_.clear();
    return appended ? Result<void>() : appended.error();
  }

  storage::SpillFile file_;
  std::vector<Record> piece_;
  std::uint64_t count_ = 0;
};

}  // namespace planetree::tools
