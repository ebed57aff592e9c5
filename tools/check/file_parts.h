#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "octree/attributes/attribute_page.h"
#include "octree/field/field_page.h"
#include "octree/page/frame.h"
#include "octree/page/mask_streams.h"
#include "octree/page/page_streams.h"
#include "planetree/error.h"
#include "planetree/metadata.h"
#include "query/file/page_decoding.h"
#include "storage/file/file_layout.h"
#include "storage/http/http_options.h"
#include "storage/set/set_source.h"
#include "storage/system/byte_source.h"
#include "storage/system/file_calls.h"
#include "tools/check/frame_view.h"
#include "tools/check/issue.h"

namespace planetree::tools {

/// Bytes aligned to a slot, as frames must be.
class AlignedBytes {
 public:
  /// Allocates `bytes`, a multiple of the slot. The old content is lost.
  void resize(std::size_t bytes) {
    if (bytes == bytes_) return;
    slots_ = std::make_unique<Slot[]>(bytes / sizeof(Slot));
    bytes_ = bytes;
  }
  std::byte* data() { return reinterpret_cast<std::byte*>(slots_.get()); }
  const std::byte* data() const { return reinterpret_cast<const std::byte*>(slots_.get()); }
  std::span<std::byte> span() { return {data(), bytes_}; }

 private:
  struct alignas(octree::kSlotBytes) Slot {
    std::byte bytes[octree::kSlotBytes];
  };
  std::unique_ptr<Slot[]> slots_;
  std::size_t bytes_ = 0;
};

/// A .ptree file that may be damaged in any part. Model::open refuses such a file; this reads what
/// is still readable.
///
/// threads  one at a time, because the page read last is kept here
class FileParts {
 public:
  /// Opens a file or a URL, and reads its headers, its directory and its extensions.
  ///
  /// http    for a URL
  /// errors  kNotFound, kPermission, kReadFailed, kNoMemory: the file cannot be opened or
  ///         read. Everything else becomes an issue.
  static Result<FileParts> open(const std::filesystem::path& path,
                                storage::FileCalls& calls = storage::FileCalls::real(),
                                const storage::HttpOptions& http = {});

  /// Issues found at open, outside of pages.
  std::span<const Issue> issues() const { return issues_; }
  /// Adds an issue outside of pages.
  void add_issue(Issue issue) { issues_.push_back(std::move(issue)); }
  std::uint64_t actual_bytes() const { return actual_bytes_; }
  const std::filesystem::path& path() const { return path_; }
  /// The set whose members have the bytes. Null if a file has them.
  const storage::SetSource* set() const {
    return dynamic_cast<const storage::SetSource*>(file_.get());
  }

  /// The header. Null if neither header is whole or this program does not know the format version.
  const storage::FileHeader* header() const { return has_header_ ? &header_ : nullptr; }
  /// Where the pages are, unchecked. Empty without a header or if the file ends within the
  /// directory.
  std::span<const storage::PageEntry> entries() const { return entries_; }
  std::uint32_t page_count() const { return static_cast<std::uint32_t>(entries_.size()); }
  std::span<const storage::ExtensionRecord> extensions() const { return extensions_; }
  /// What the file says of the model. Empty if it says nothing or that is damaged.
  const Metadata& metadata() const { return metadata_; }
  /// Number of the first mask page.
  std::uint32_t first_mask_page() const {
    return std::min(header_.first_mask_page(), page_count());
  }
  /// Number of the first field page.
  std::uint32_t first_field_page() const {
    return std::min(header_.first_field_page(), page_count());
  }
  /// Number of the first attribute page.
  std::uint32_t first_attribute_page() const {
    return std::min(header_.first_attribute_page(), page_count());
  }
  bool is_field_page(std::uint32_t page) const {
    return page >= first_field_page() && page < first_attribute_page();
  }
  bool is_attribute_page(std::uint32_t page) const {
    return page >= first_attribute_page() && page < first_mask_page();
  }
  /// Number of the first cap page. Pages before it are distance pages.
  std::uint32_t first_cap_page() const { return std::min(header_.first_cap_page(), page_count()); }
  /// Layout of the page read last: of the surface or, if it is a cap page, of the caps.
  octree::BlockShape shape() const {
    const bool caps = page_ >= first_cap_page() && page_ < first_field_page();
    octree::BlockShape shape = caps ? query::cap_shape(header_) : query::block_shape(header_);
    shape.links = links().target();
    return shape;
  }
  /// Format of the links of nodes. They have numbers of records, whatever their file's links have.
  octree::LinkFormat links() const { return octree::LinkFormat::numbered(header_.page_bytes); }

  /// Link to the root of the surface's tree.
  std::uint32_t root_link() const {
    return octree::root_link_of(header_.page_bytes, links().target(), 0, header_.model.node_count);
  }

  /// Reads a page's stored bytes, checks the hash and decompresses them. Empty if sound.
  std::optional<Issue> read_page(std::uint32_t page);
  /// Decodes the page read last to its frame. Empty if sound.
  std::optional<Issue> decode_page();

  /// Reads a page and decodes it. Empty if sound.
  std::optional<Issue> load_page(std::uint32_t page) {
    std::optional<Issue> issue = read_page(page);
    return issue ? issue : decode_page();
  }

  /// Raw bytes of the page read last. Valid until the next read.
  std::span<const std::byte> raw() const { return raw_; }
  /// Splits the raw bytes of a distance page or a cap page into streams. False if they do not fit
  /// the page head.
  bool read(octree::RawStreams& streams) const;
  /// Splits the raw bytes of a mask page into streams. False if they do not fit the page head or
  /// the page is not a mask page.
  bool read(octree::MaskStreams& streams) const;
  /// Head of the page read last, if that is a mask page.
  std::optional<octree::MaskPageHead> mask_head() const;
  /// Head of the page read last, if that is a field page.
  std::optional<octree::FieldPageHead> field_head() const;
  /// Head of the page read last, if that is an attribute page.
  std::optional<octree::AttributePageHead> attribute_head() const;
  /// The page decoded last, which must be a distance page or a cap page. Valid until the next
  /// decode_page().
  FrameView frame() const { return FrameView(frame_.data(), shape()); }
  const std::byte* frame_bytes() const { return frame_.data(); }

 private:
  FileParts() = default;

  octree::PageInfo info_of_page(const storage::PageEntry& entry) const;
  Result<void> load();
  Result<void> load_extensions();
  Result<void> load_extension(const storage::ExtensionRecord& record);
  Result<void> load_directory();
  void check_header();
  void check_lengths();
  Result<void> read_at(std::uint64_t offset, std::span<std::byte> out) const;
  const char* fault_of(const storage::PageEntry& entry) const;

  std::filesystem::path path_;
  std::unique_ptr<storage::ByteSource> file_;
  std::uint64_t actual_bytes_ = 0;
  bool has_header_ = false;
  storage::FileHeader header_{};
  std::vector<storage::ExtensionRecord> extensions_;
  Metadata metadata_;
  std::vector<storage::PageEntry> entries_;
  std::vector<Issue> issues_;

  std::uint32_t page_ = 0;
  std::vector<std::byte> stored_;
  std::vector<std::byte> raw_;
  AlignedBytes frame_;
};

}  // namespace planetree::tools
