#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "octree/page/frame.h"
#include "storage/file/file_layout.h"
#include "tests/storage/file/file_image.h"

namespace planetree::storage {

/// A page of a forged file: its key and its raw bytes.
struct ForgedPage {
  std::uint64_t octcode = 0;
  Bytes raw;
};

/// A .ptree file taken apart, so that what its pages hold can be changed. It is put together with
/// the lengths, offsets and hashes of section 2 of the specification, so that a reader refuses a
/// change for what it means and not for a hash.
struct ForgedFile {
  static constexpr std::uint32_t kMaxPages = 64;

  FileHeader header{};
  std::vector<ForgedPage> pages;

  /// Takes a file apart. Empty if the header or a page cannot be read, or there are no pages, or
  /// many.
  static std::optional<ForgedFile> of(std::span<const std::byte> bytes);
  /// Puts the file together. Each page is compressed again.
  [[nodiscard]] Bytes bytes() const;

  [[nodiscard]] octree::BlockShape shape() const;
  [[nodiscard]] bool is_mask(std::size_t page) const {
    return page + header.model.mask_page_count >= pages.size();
  }
};

}  // namespace planetree::storage
