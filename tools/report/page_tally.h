#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "tools/check/file_parts.h"
#include "tools/report/file_survey.h"

namespace planetree::tools {

/// Kinds of pages, in the order in which they are in a file.
enum class PageKind : std::uint8_t { kDistance, kCaps, kField, kAttributes, kMask };
inline constexpr std::size_t kPageKindCount = 5;
/// The kind's name in reports, such as "distance".
[[nodiscard]] std::string_view page_kind_name(PageKind kind);
[[nodiscard]] PageKind kind_of(const FileParts& parts, std::uint32_t page);

/// Counts of the pages of a file by size and along the file. Its own size does not depend on
/// theirs.
class PageTally {
 public:
  static constexpr std::size_t kSizes = 32, kMaxWindows = 96;

  /// Counts of neighbouring pages, in the order of the file.
  struct Window {
    std::uint32_t first = 0, last = 0;  ///< their numbers
    std::uint64_t stored_bytes = 0;
    std::uint64_t raw_bytes = 0;  ///< before compression
    std::uint32_t unreadable = 0;
    std::array<std::uint32_t, kPageKindCount> pages{};  ///< by kind
  };
  /// Pages by stored size: bin i has those of at least i * kSizes-th of page_bytes, and the last
  /// bin also all that are larger.
  using Sizes = std::array<std::array<std::uint32_t, kPageKindCount>, kSizes>;

  /// parts  must outlive this
  explicit PageTally(const FileParts& parts) : parts_(&parts) {}

  /// Adds a page. Pages come in ascending order.
  void add(const PageRow& row);

  const std::vector<Window>& windows() const { return windows_; }
  const Sizes& sizes() const { return sizes_; }
  std::uint32_t unreadable() const { return unreadable_; }

 private:
  const FileParts* parts_;
  std::vector<Window> windows_;
  Sizes sizes_{};
  std::uint32_t unreadable_ = 0;
};

}  // namespace planetree::tools
