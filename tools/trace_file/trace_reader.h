#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "planetree/trace.h"
#include "tools/cli/input_file.h"
#include "tools/trace_file/trace_coding.h"
#include "tools/trace_file/trace_header.h"
#include "tools/trace_file/trace_layout.h"

namespace planetree::tools {

/// Reads a trace file in pieces. Trusts nothing in it: every byte is covered by a checksum, and
/// what is under a right checksum is checked too. Memory is bounded by the size of the file.
///
/// errors  kNotPlanetree: not a trace file; kUnsupported: another version; kTruncated: the file was
///         cut or has bytes after its end; kDamaged; those of reading a file. Texts say what to do.
class TraceReader {
 public:
  /// Opens a file and reads its header.
  static Result<TraceReader> open(const std::string& path);

  const TraceHeader& header() const { return header_; }
  /// Reads the next records, in the order of the file. Returns their number; 0 at the end.
  Result<std::size_t> read(std::span<PageAccess> accesses);
  /// The totals, once read() has returned 0.
  const TraceTotals& totals() const { return totals_; }
  /// The pages of the records read so far, in the order of their first occurrence.
  const std::vector<TracePage>& pages() const { return decoder_.pages(); }

 private:
  TraceReader(InputFile file, const TraceHeader& header, std::uint64_t seed, std::uint64_t offset)
      : file_(std::move(file)),
        header_(header),
        decoder_(header.rate_hz, header.pages),
        seed_(seed),
        offset_(offset) {}
  Result<void> read_chunk();
  Result<void> finish();

  InputFile file_;
  TraceHeader header_;
  TraceDecoder decoder_;
  std::vector<std::byte> raw_;  // of the chunk
  TraceTotals totals_;
  std::uint64_t records_ = 0;  // read so far
  std::uint64_t seed_;         // of the next chunk's hash
  std::uint64_t offset_;       // of the next chunk
  bool is_at_end_ = false;
};

}  // namespace planetree::tools
