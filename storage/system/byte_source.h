#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "planetree/error.h"
#include "storage/system/file_handle.h"

namespace planetree::storage {

/// Bytes [offset, offset + bytes) of a source.
struct ByteRange {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
};

/// Counters of a source on another machine; all 0 for a file of this one.
struct SourceStats {
  std::uint64_t requests = 0;      ///< requests sent, repeated ones included
  std::uint64_t bytes = 0;         ///< bytes of replies, without their heads
  std::uint64_t cached_bytes = 0;  ///< bytes that a cache on disk had instead
  std::uint64_t rounds = 0;        ///< round trips one after the other: requests at once count once
};

/// Immutable bytes of a known length that are read by ranges: a file of this machine, or an object
/// that a server has.
///
/// threads  any number at once
class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// What errors call the source besides the path that it was opened by; empty: nothing.
  virtual std::string_view name() const noexcept { return {}; }
  /// Whether a read takes a request to another machine: then no read waits for less than a round
  /// trip, and a failed one may succeed later.
  virtual bool is_remote() const noexcept { return false; }
  /// Length in bytes when the source was opened.
  virtual std::uint64_t size_bytes() const noexcept = 0;
  /// Memory that the source holds, in bytes.
  virtual std::uint64_t memory_bytes() const noexcept { return 0; }
  virtual SourceStats stats() const noexcept { return {}; }

  /// Fills `out` with the bytes from `offset` on. Waits for as long as that takes.
  ///
  /// what    the action to name in an error, worded to follow "cannot"
  /// errors  kReadFailed; kTruncated: the source ends too early
  virtual Result<void> read_at(std::uint64_t offset, std::span<std::byte> out,
                               const char* what = "read the file") const noexcept = 0;
  /// Does the same within the time limits of `terms`. Returns false if the bytes do not come in
  /// time or cannot be read; see FileHandle::try_read().
  virtual bool try_read(std::uint64_t offset, std::span<std::byte> out,
                        const ReadLimits& terms) const noexcept = 0;
  /// Reads bytes once, while the source is opened.
  virtual Result<void> read_early(std::uint64_t offset, std::span<std::byte> out) const noexcept {
    return read_at(offset, out);
  }

  /// Reads ranges that read_at() asks for soon, many at once if the source can. A failure is no
  /// error: read_at() meets it again.
  ///
  /// ranges  within the source, in any order
  virtual void prefetch(std::span<const ByteRange> /*ranges*/) const noexcept {}
  /// Does the same for at most `max_time`. What has not come by then is given up.
  virtual void prefetch_within(std::span<const ByteRange> ranges,
                               std::chrono::milliseconds /*max_time*/) const noexcept {
    prefetch(ranges);
  }
  /// Whether read_at() of a range takes no request to another machine.
  virtual bool is_here(const ByteRange& /*range*/) const noexcept { return true; }
  /// Forgets what the source keeps of a range, because the bytes were wrong. Returns whether a
  /// second read may find others.
  virtual bool forget(const ByteRange& /*range*/) const noexcept { return false; }
};

/// Opens a regular file of this machine, or a link to one.
///
/// calls   the system; must outlive the source
/// errors  those of file_error(); kNotPlanetree: it is a directory, device, pipe or socket;
///         kNoMemory
Result<std::unique_ptr<ByteSource>> open_file_source(const char* path, FileCalls& calls) noexcept;

}  // namespace planetree::storage
