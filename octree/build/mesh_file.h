#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "planetree/error.h"

namespace planetree::octree {

/// A mesh file mapped read-only. The size is taken once, at open; the file must
/// not shrink while this lives, or reading it ends the process with SIGBUS.
class MeshFile {
 public:
  /// path              a regular file, possibly empty
  /// max_mapped_bytes  about the most to keep mapped in memory; 0: no limit
  static Result<MeshFile> open(const std::filesystem::path& path, std::uint64_t max_mapped_bytes);

  MeshFile(MeshFile&& other) noexcept;
  MeshFile& operator=(MeshFile&&) = delete;
  ~MeshFile();

  [[nodiscard]] const std::byte* bytes() const noexcept { return bytes_; }
  [[nodiscard]] std::uint64_t size_bytes() const noexcept { return size_bytes_; }
  /// The same bytes, as characters.
  [[nodiscard]] std::string_view text() const noexcept {
    return {reinterpret_cast<const char*>(bytes_), size_bytes_};
  }

  /// Says that `offset` is about to be read, so that pages can be let go once
  /// more than max_mapped_bytes of them may be in memory. The bytes stay
  /// readable in any case: they are mapped again on the next read.
  void touch(std::uint64_t offset) noexcept {
    if (max_windows_ == 0) return;
    const std::uint64_t window = offset / kWindowBytes;
    if (window != last_window_) enter_window(window);
  }

 private:
  /// A page fault maps the pages around it that are cached, up to this much;
  /// hence memory is counted in such windows and not in pages.
  static constexpr std::uint64_t kWindowBytes = 65536;
  static constexpr std::uint64_t kNoWindow = ~std::uint64_t{0};

  MeshFile(const std::byte* bytes, std::uint64_t size_bytes, std::uint64_t max_mapped_bytes);
  void enter_window(std::uint64_t window) noexcept;

  const std::byte* bytes_ = nullptr;
  std::uint64_t size_bytes_ = 0;
  std::uint64_t max_windows_ = 0;  ///< 0: windows are not counted
  std::uint64_t window_count_ = 0;
  std::uint64_t last_window_ = kNoWindow;
  std::vector<bool> windows_;  ///< entered since pages were last let go
};

}  // namespace planetree::octree
