#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "octree/page/mask_streams.h"
#include "octree/page/raw_streams.h"
#include "planetree/error.h"
#include "query/file/page_decoding.h"
#include "storage/file/file_layout.h"
#include "storage/system/file_calls.h"
#include "storage/system/file_handle.h"
#include "tools/check/aligned_bytes.h"
#include "tools/check/frame_view.h"
#include "tools/check/issue.h"

namespace planetree::tools {

/// A .ptree file of which any part may be damaged. Where a reader that wants
/// answers refuses the file, this goes on with whatever can still be read.
///
/// threads  one at a time: the page read last is kept in here.
class FileParts {
 public:
  /// errors  kNotFound, kPermission, kReadFailed, kNoMemory: what cannot be
  ///         opened or read at all. All else is an issue of the file.
  static Result<FileParts> open(const std::filesystem::path& path,
                                storage::FileCalls& calls = storage::FileCalls::real());

  /// Found at open: outside the pages.
  std::span<const Issue> issues() const { return issues_; }
  std::uint64_t actual_bytes() const { return actual_bytes_; }
  const std::filesystem::path& path() const { return path_; }

  /// Null if neither header is whole, or if this program does not know its format.
  const storage::FileHeader* header() const { return has_header_ ? &header_ : nullptr; }
  /// As the table says, which may be wrong; empty without a header or if the
  /// file ends before the table does.
  std::span<const storage::PageEntry> entries() const { return entries_; }
  std::uint32_t page_count() const { return static_cast<std::uint32_t>(entries_.size()); }
  /// Pages before it are distance pages, the others the mask's.
  std::uint32_t first_mask_page() const {
    return std::min(header_.first_mask_page(), page_count());
  }
  octree::BlockShape shape() const { return query::block_shape(header_.model); }

  /// Reads a page's raw bytes and verifies them; nothing if all is well.
  std::optional<Issue> read_page(std::uint32_t page);
  /// Unpacks the page read last into its frame.
  std::optional<Issue> decode_page();

  /// Of the page read last; good until the next.
  std::span<const std::byte> raw() const { return raw_; }
  /// The same, of a distance page, cut into streams; false if they are not what
  /// the head says.
  bool cut(octree::RawStreams& streams) const;
  /// The same of a mask page; false if that is not one.
  bool cut(octree::MaskStreams& streams) const;
  /// The head of the mask page read last; nothing if that is not one.
  std::optional<octree::MaskPageHead> mask_head() const;
  /// Of the page decoded last, if a distance page; good until the next.
  FrameView frame() const { return FrameView(frame_.data(), shape()); }
  const std::byte* frame_bytes() const { return frame_.data(); }

 private:
  FileParts() = default;
  Result<void> load();
  Result<void> load_table();
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const;
  const char* fault_of(const storage::PageEntry& entry) const;

  std::filesystem::path path_;
  storage::FileHandle file_;
  std::uint64_t actual_bytes_ = 0;
  bool has_header_ = false;
  storage::FileHeader header_{};
  std::vector<storage::PageEntry> entries_;
  std::vector<Issue> issues_;

  std::uint32_t page_ = 0;
  std::vector<std::byte> stored_;
  std::vector<std::byte> raw_;
  AlignedBytes frame_;
};

}  // namespace planetree::tools
