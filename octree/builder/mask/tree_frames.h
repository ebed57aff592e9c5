#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "octree/builder/mask/built_mask.h"
#include "octree/builder/tree/built_tree.h"
#include "octree/traversal/tree_view.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Frames of the pages of the trees of a model that is being built, and of its mask, for
/// traversals. Keeps the pages that were used last. One thread.
class TreeFrames {
 public:
  /// Maximum memory of the frames.
  static constexpr std::size_t kBytes = std::size_t{16} << 20;

  /// trees, mask  must outlive this. If `mask` is null there are only the pages of the trees.
  explicit TreeFrames(const BuiltTrees& trees, const BuiltMask* mask = nullptr);
  TreeFrames(const TreeFrames&) = delete;
  TreeFrames& operator=(const TreeFrames&) = delete;

  PageReader reader() { return {this, &TreeFrames::page, &TreeFrames::peek}; }

  /// The error of the first page that could not be read.
  /// errors  those of reading spilled data and of decoding; kNoMemory.
  const Result<void>& state() const { return state_; }

 private:
  static constexpr std::uint32_t kNoPage = ~std::uint32_t{0};
  struct Frame {
    std::uint32_t page = kNoPage;
    std::uint64_t last_use = 0;  // uses_ at the last use
  };
  struct Line {
    alignas(kSlotBytes) std::byte bytes[kSlotBytes];
  };

  static const std::byte* page(void* frames, std::uint32_t number) noexcept;
  static const std::byte* peek(void* frames, std::uint32_t number) noexcept;
  const std::byte* load_page(std::uint32_t number);
  Result<void> decode(std::uint32_t number, std::span<std::byte> frame) const;
  std::size_t acquire_frame();
  std::span<std::byte> bytes_of(std::size_t frame);

  const BuiltTrees trees_;
  const BuiltMask* const mask_;
  const std::size_t page_lines_;
  const std::size_t max_;
  std::vector<Line> lines_;
  std::vector<Frame> frames_;
  std::unordered_map<std::uint32_t, std::size_t> frame_of_;  // frame of each page
  std::uint64_t uses_ = 0;
  Result<void> state_;
};

}  // namespace planetree::octree
