#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

#include "planetree/error.h"
#include "planetree/trace.h"
#include "tools/cli/output_file.h"
#include "tools/trace_file/trace_coding.h"
#include "tools/trace_file/trace_header.h"

namespace planetree::tools {

/// Writes a trace file while a session runs. The file gets its name when it is complete.
class TraceWriter {
 public:
  /// Opens the file. errors: as OutputFile::create
  static Result<TraceWriter> create(const std::filesystem::path& path, bool may_replace);

  /// Writes the header. Call it once, before add(). errors: as OutputFile::write
  Result<void> begin(const TraceHeader& header);
  /// Appends records. errors: as OutputFile::write
  Result<void> add(std::span<const PageAccess> accesses);
  /// Completes the file. errors: as OutputFile::write
  ///
  /// ticks  of the session
  /// lost   records that the page trace dropped
  Result<void> finish(std::uint64_t ticks, std::uint64_t lost);

  std::uint64_t bytes_written() const { return file_.bytes_written(); }

 private:
  explicit TraceWriter(OutputFile file) : file_(std::move(file)) {}
  Result<void> write_chunk(std::uint32_t kind, std::span<const std::byte> raw);

  OutputFile file_;
  std::optional<TraceEncoder> encoder_;
  TraceTotals totals_;
  std::uint64_t seed_ = 0;  // of the next chunk's hash
};

}  // namespace planetree::tools
