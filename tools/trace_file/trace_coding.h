#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "planetree/error.h"
#include "planetree/trace.h"

namespace planetree::tools {

/// A page of a trace, as described where it first occurs.
struct TracePage {
  std::uint32_t page = 0;
  std::uint32_t stored_bytes = 0;
  std::uint64_t octcode = 0;
  PageAccess::Section section = PageAccess::Section::kTree;
};

/// What a record is coded relative to: the last record of its chunk.
struct TraceState {
  std::uint64_t time_ns = 0;
  std::uint64_t query = 0;
  std::uint32_t probe = 0;
  std::uint8_t kind = 0;
  std::uint32_t page = 0;  ///< index in the table of pages
  Vec3 position;
  bool has_position = false;
};

/// Encodes records into chunks.
class TraceEncoder {
 public:
  explicit TraceEncoder(double rate_hz) : rate_hz_(rate_hz) {}

  void add(const PageAccess& access);
  /// Size of the chunk so far, at least that of its raw bytes less 16.
  std::size_t bytes() const { return records_.size() + pages_.size(); }
  /// Ends the chunk. Returns its raw bytes.
  std::vector<std::byte> take();

 private:
  std::uint32_t index_of(const PageAccess& access);
  void add_motion(const PageAccess& access);

  const double rate_hz_;
  std::vector<std::byte> pages_, records_;  // of the chunk
  std::uint32_t new_pages_ = 0;
  TraceState state_;
  std::unordered_map<std::uint32_t, std::uint32_t> indices_;  // by page
};

/// Decodes the records of chunks. Trusts nothing.
class TraceDecoder {
 public:
  /// pages  number of pages of the model
  TraceDecoder(double rate_hz, std::uint32_t pages) : rate_hz_(rate_hz), page_count_(pages) {}

  /// Begins a chunk, whose raw bytes must outlive its records.
  ///
  /// errors  kDamaged
  Result<void> begin(std::span<const std::byte> raw);
  bool at_end() const { return at_ == raw_.size(); }
  /// errors  kDamaged
  Result<PageAccess> next();
  /// The pages described so far, in the order of their first occurrence.
  const std::vector<TracePage>& pages() const { return pages_; }

 private:
  bool take(std::size_t count, std::uint64_t& value);
  bool take_varint(std::uint64_t& value);
  bool take_difference(std::uint64_t& value);
  bool take_page();
  bool take_context();
  bool take_details(PageAccess& access);
  bool take_motion(PageAccess& access);

  const double rate_hz_;
  const std::uint32_t page_count_;
  std::span<const std::byte> raw_;
  std::size_t at_ = 0;
  TraceState state_;
  std::vector<TracePage> pages_;
};

}  // namespace planetree::tools
