#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "octree/page/page_decoder.h"
#include "planetree/attributes.h"
#include "planetree/error.h"

/// The raw bytes of an attribute page, specified in format-spec/v1/spec.md, "Attribute page": a
/// head, then these streams, without padding and byte-stream split. Each of them but the first two
/// is there if the file keeps the attribute:
///
///     triangle pages   u32 a triangle: page of the block that has it
///     triangle blocks  u16 a triangle: number of that block in its page
///     colours          u8 x 12 a triangle: red, green, blue and alpha of its corners
///     uvs              float x 6 a triangle: u and v of its corners
///     values           u64 a triangle
///
/// The triangles of all pages together are those of all indices, in their order.
namespace planetree::octree {

struct AttributePageHead {
  std::uint32_t page_number;
  std::uint32_t ordinal;         ///< number of the page among the attribute pages
  std::uint64_t octcode;         ///< 0: the root's
  std::uint32_t triangle_count;  ///< of the page
  std::uint32_t reserved;        ///< 0
};
static_assert(sizeof(AttributePageHead) == 24);

/// Link of an index without a triangle in the file, in a frame and as stored.
inline constexpr std::uint32_t kNoLink = ~std::uint32_t{0};
inline constexpr StoredLink kNoStoredLink = {0xffffffff, 0xffff};

/// What the attribute pages of a file have for each triangle, and where a decoded page has it.
///
/// kept  kKeepTriangles and others, as the file's header has them.
struct AttributeShape {
  static constexpr std::size_t kHeadBytes = 64;
  static constexpr std::size_t kLinkBytes = 4, kColorBytes = 12, kUvBytes = 24, kValueBytes = 8;
  static constexpr std::size_t kStoredLinkBytes = 6;  ///< a frame has a link in kLinkBytes

  std::uint32_t kept = 0;

  constexpr bool has_colors() const { return (kept & kKeepColor) != 0; }
  constexpr bool has_uvs() const { return (kept & kKeepUv) != 0; }
  constexpr bool has_values() const { return (kept & kKeepValue) != 0; }
  /// Bytes of one triangle in a frame.
  constexpr std::size_t triangle_bytes() const { return kLinkBytes + extra_bytes(); }
  /// Bytes of one triangle beside its link: colours, uvs and value, in this order.
  constexpr std::size_t extra_bytes() const {
    return (has_colors() ? kColorBytes : 0) + (has_uvs() ? kUvBytes : 0) +
           (has_values() ? kValueBytes : 0);
  }
  /// Maximum number of triangles in a page.
  constexpr std::uint32_t triangles_per_page(std::uint32_t page_bytes) const {
    return static_cast<std::uint32_t>((page_bytes - kHeadBytes) / triangle_bytes());
  }
};

/// A decoded attribute page in its frame: a head of kHeadBytes, then values, links, uvs and
/// colours.
class AttributeView {
 public:
  /// frame  of decode_attribute_page().
  AttributeView(const std::byte* frame, AttributeShape shape) : frame_(frame), shape_(shape) {
    AttributePageHead head;
    std::memcpy(&head, frame, sizeof head);
    count_ = head.triangle_count;
  }

  std::uint32_t count() const { return count_; }
  /// Returns the numbered link (LinkFormat) of the block that has a triangle, or kNoLink.
  std::uint32_t link(std::uint32_t triangle) const {
    return at<std::uint32_t>(links_at(shape_, count_), triangle);
  }
  std::array<Color, 3> colors(std::uint32_t triangle) const {
    return at<std::array<Color, 3>>(colors_at(shape_, count_), triangle);
  }
  std::array<TextureCoordinate, 3> uvs(std::uint32_t triangle) const {
    return at<std::array<TextureCoordinate, 3>>(uvs_at(shape_, count_), triangle);
  }
  std::uint64_t value(std::uint32_t triangle) const {
    return at<std::uint64_t>(AttributeShape::kHeadBytes, triangle);
  }

  /// Offsets of the arrays in the frame of a page with `count` triangles.
  static constexpr std::size_t links_at(AttributeShape shape, std::size_t count) {
    return AttributeShape::kHeadBytes +
           (shape.has_values() ? count * AttributeShape::kValueBytes : 0);
  }
  static constexpr std::size_t uvs_at(AttributeShape shape, std::size_t count) {
    return links_at(shape, count) + count * AttributeShape::kLinkBytes;
  }
  static constexpr std::size_t colors_at(AttributeShape shape, std::size_t count) {
    return uvs_at(shape, count) + (shape.has_uvs() ? count * AttributeShape::kUvBytes : 0);
  }

 private:
  template <class T>
  T at(std::size_t offset, std::uint32_t triangle) const {
    T value;
    std::memcpy(&value, frame_ + offset + triangle * sizeof(T), sizeof value);
    return value;
  }

  const std::byte* frame_;
  AttributeShape shape_;
  std::uint32_t count_ = 0;
};
static_assert(sizeof(std::array<Color, 3>) == AttributeShape::kColorBytes);
static_assert(sizeof(std::array<TextureCoordinate, 3>) == AttributeShape::kUvBytes);

/// Unpacks the raw bytes of an attribute page into its frame.
///
/// raw      arbitrary bytes; everything in them is checked before it is used
/// info     of the page; info.tree_pages is the number of distance pages
/// count    triangles that the page must have, at most shape.triangles_per_page()
/// frame    info.page_bytes bytes; undefined after an error
/// return   on success, every link is kNoLink or that of a block of a distance page by its form;
///          whether the page has that block is not known
/// errors   kDamaged, naming the page and the fault
/// threads  any; no allocation, no exception
Result<void> decode_attribute_page(std::span<const std::byte> raw, const PageInfo& info,
                                   AttributeShape shape, std::uint32_t count,
                                   std::span<std::byte> frame) noexcept;

}  // namespace planetree::octree
