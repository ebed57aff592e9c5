#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <numeric>
#include <type_traits>

/// Layout of a .ptree file outside its pages: see "File" in format-spec/v1/spec.md. All integers
/// and floats are little-endian. The structs have exactly the bytes of the file.
///
///   offset                 part                length
///   0                      header              kHeaderBytes
///   kHeaderBytes           extension records   extension_count * sizeof(ExtensionRecord)
///   ...                    directory           DirectoryShape::bytes()
///   ...                    pages               stored bytes from page 0 on, without gaps: distance
///                                              pages, cap pages, field pages, attribute pages,
///                                              mask pages
///   ...                    extensions          their bytes, without gaps
///   file_bytes - 1024      header's copy       kHeaderBytes
namespace planetree::storage {

static_assert(std::endian::native == std::endian::little,
              "planetree reads and writes its structs in place: little-endian machines only");

inline constexpr std::uint8_t kMagic[8] = {0x89, 'P', 'T', 'R', 'E', 'E', 0x0d, 0x0a};
/// Major version times 256, plus minor version. A reader reads every minor version of its major
/// version.
inline constexpr std::uint16_t kFormatVersion = 0x100;
inline constexpr std::size_t kHeaderBytes = 1024;
inline constexpr std::uint64_t kKnownIncompatibleFeatures = 0;
inline constexpr std::uint32_t kMinPageBytes = 4096;
inline constexpr std::uint32_t kMaxPageBytes = 262144;
/// Maximum number of grid points of a field. A field page has at most page_bytes /
/// kFieldPointShare.
inline constexpr std::uint64_t kMaxFieldPoints = std::uint64_t{1} << 20;
inline constexpr std::uint32_t kFieldPointShare = 8;
/// Bytes of a page that its attributes do not use, so that a decoded page has room for its head.
inline constexpr std::uint32_t kAttributeHeadBytes = 64;
inline constexpr std::uint64_t kNoTriangle = ~std::uint64_t{0};

enum class VertexKind : std::uint8_t { kFloat32 = 0, kFloat64 = 1 };

/// How queries decide sides, unless they choose a rule themselves.
enum class SideRule : std::uint8_t {
  kSolid = 0,   ///< by the winding number
  kSurface = 1  ///< by the pseudo-normal of the nearest feature
};

/// Attributes of triangles, as bits of ModelRecord::attributes.
inline constexpr std::uint8_t kAttributeLinks = 1;   ///< where the triangle is
inline constexpr std::uint8_t kAttributeColors = 2;  ///< three colours of 4 bytes
inline constexpr std::uint8_t kAttributeUvs = 4;     ///< three pairs of floats
inline constexpr std::uint8_t kAttributeValues = 8;  ///< 8 bytes
inline constexpr std::uint8_t kKnownAttributes =
    kAttributeLinks | kAttributeColors | kAttributeUvs | kAttributeValues;

/// Type of the values of kAttributeValues.
enum class ValueKind : std::uint8_t { kUnsigned = 0, kSigned = 1, kReal = 2 };

/// An edge along which more triangles run in one direction than in the other.
struct UnbalancedEdge {
  double from[3];          ///< start of the edge in the direction of `triangle`; input coordinates
  double to[3];            ///< end of the edge; input coordinates, exact like `from`
  std::uint64_t triangle;  ///< minimum index of a triangle with this edge
  std::uint32_t along;     ///< number of triangles that run from `from` to `to`
  std::uint32_t against;   ///< number of triangles that run from `to` to `from`
};
static_assert(sizeof(UnbalancedEdge) == 64);

/// Facts about the whole model. The model frame is the input's coordinates times
/// 2^scale_exponent, so that the longest edge of the core lies in [1, 2). The core is the box of
/// all triangles but the strays, which are few and far outside.
struct ModelRecord {
  std::uint64_t triangle_count;         ///< triangles in the file: those of the region, if any
  std::uint64_t skipped_count;          ///< triangles of skipped records, which are not in the file
  std::uint64_t first_skipped;          ///< index of the first such triangle, or kNoTriangle
  std::uint64_t vertex_count;           ///< vertex records of the input
  std::uint64_t node_count;             ///< nodes of the tree
  std::uint64_t block_count;            ///< blocks of the tree
  double box_lower[3];                  ///< box of the whole input; input coordinates, exact
  double box_upper[3];                  ///< likewise
  double centre[3];                     ///< model frame; boxes and planes are relative to it
  double sample[3];                     ///< model frame; a vertex of sample_triangle
  std::uint64_t sample_triangle;        ///< minimum index of a triangle in the file
  std::int32_t scale_exponent;          ///< model frame = input * 2^scale_exponent
  VertexKind vertex_kind;               ///< type of stored coordinates
  std::uint8_t triangle_id_bytes;       ///< bytes of a stored triangle index: 4 or 8
  std::uint8_t height;                  ///< maximum number of nodes on a path from root to block
  std::uint8_t reserved[9];             ///< zero
  std::uint64_t unbalanced_edge_count;  ///< in the whole input; 0: the surface is watertight
  UnbalancedEdge unbalanced_edge[3];    ///< first ones by triangle, then corner; unused ones zero
  std::uint64_t mask_cell_count;        ///< grey cells of the mask
  std::uint32_t mask_page_count;        ///< mask pages, the last of the file; 0: there is no mask
  std::uint8_t mask_levels;             ///< level of the finest grey cell
  std::uint8_t mask_reserved[3];        ///< zero
  /// Number of usable triangles of the input, if the file holds only those that touch a region.
  /// 0: the file holds the whole input, and the fields below are zero.
  std::uint64_t input_triangles;
  double region_lower[3];       ///< input coordinates
  double region_upper[3];       ///< likewise
  std::int64_t region_winding;  ///< winding number at the lower corner of the mask's root cell
  double core_lower[3];         ///< core of the whole input; input coordinates, exact
  double core_upper[3];         ///< likewise
  std::uint64_t stray_count;    ///< triangles of the input that are not in the core
  /// Model frame: no less than any edge of a stray that has an edge longer than its gap to the
  /// core; 0 if there is none. Distances to such strays are less certain.
  double stray_edge;
  std::uint64_t cap_count;        ///< caps that close the surface; 0: watertight, or no side layer
  std::uint64_t cap_node_count;   ///< nodes of the tree of caps
  std::uint64_t cap_block_count;  ///< blocks of the tree of caps
  double cap_area;                ///< sum of the caps' areas; model frame
  std::uint32_t cap_page_count;   ///< cap pages, between distance pages and mask pages
  std::uint8_t cap_height;        ///< of the tree of caps, as `height`
  std::uint8_t cap_reserved[11];  ///< zero
  /// How open the surface of the whole input is: the length of the sum of the area vectors, divided
  /// by the sum of the areas; 0 to 1.
  double openness;
  SideRule side_rule;           ///< how queries decide sides by default
  std::uint8_t side_is_chosen;  ///< 1: the builder was told side_rule; 0: it follows from openness
  std::uint8_t without_sides;   ///< 1: the file has no side layer, that is no caps and no mask
  std::uint8_t side_reserved[5];       ///< zero
  double field_lower[3];               ///< coarse field: first grid point; model frame
  double field_step;                   ///< distance from grid point to grid point; model frame
  double field_quantum;                ///< unit of stored surface points; model frame
  std::uint32_t field_size[3];         ///< grid points along each axis; 0: there is no field
  std::uint32_t field_page_count;      ///< field pages, between cap pages and attribute pages
  std::uint32_t attribute_page_count;  ///< attribute pages, between field pages and mask pages
  std::uint8_t attributes;             ///< kAttributeLinks and others; 0: no attribute pages
  ValueKind value_kind;                ///< 0 without kAttributeValues
  std::uint8_t attribute_reserved[2];  ///< zero

  [[nodiscard]] bool has_region() const noexcept { return input_triangles > 0; }
  [[nodiscard]] bool has_side_layer() const noexcept { return without_sides == 0; }
  /// Number of usable triangles of the whole input.
  [[nodiscard]] std::uint64_t usable_triangles() const noexcept {
    return has_region() ? input_triangles : triangle_count;
  }
  /// Number of triangle indices of the whole input, those of skipped records included; 2^64 - 1 if
  /// there are more.
  [[nodiscard]] std::uint64_t index_count() const noexcept {
    const std::uint64_t usable = usable_triangles();
    return skipped_count > kNoTriangle - usable ? kNoTriangle : usable + skipped_count;
  }
  /// Bytes of the attributes of one triangle.
  [[nodiscard]] std::uint32_t attribute_bytes() const noexcept {
    return ((attributes & kAttributeLinks) != 0 ? 4U : 0U) +
           ((attributes & kAttributeColors) != 0 ? 12U : 0U) +
           ((attributes & kAttributeUvs) != 0 ? 24U : 0U) +
           ((attributes & kAttributeValues) != 0 ? 8U : 0U);
  }
};
static_assert(sizeof(ModelRecord) == 640);

/// Kinds of pages, in the order in which a file has them.
enum class PageKind : std::uint8_t { kDistance, kCaps, kField, kAttributes, kMask };
inline constexpr unsigned kPageKinds = 5;

struct FileHeader {
  std::uint8_t magic[8];                ///< kMagic
  std::uint16_t version;                ///< kFormatVersion
  std::uint16_t header_bytes;           ///< kHeaderBytes
  std::uint32_t page_bytes;             ///< bytes of a decoded page; a power of two
  std::uint64_t incompatible_features;  ///< readers refuse a file with an unknown bit
  std::uint64_t compatible_features;    ///< readers ignore unknown bits
  std::uint64_t file_bytes;             ///< exact length of the file
  std::uint64_t content_id[2];          ///< XXH3-128 of the directory's root block, low word first
  std::uint64_t extensions_hash;        ///< XXH3-64 of the extension records
  std::uint64_t stored_bytes[kPageKinds];  ///< of all pages of a kind
  std::uint32_t page_count;                ///< at least 1
  std::uint32_t extension_count;           ///< at most kMaxExtensions
  std::uint32_t max_raw_bytes;             ///< largest PageEntry::raw_bytes
  std::uint32_t max_stored_bytes;          ///< largest PageEntry::stored_bytes
  ModelRecord model;
  std::uint8_t reserved[256];  ///< zero
  std::uint64_t header_hash;   ///< XXH3-64 of all bytes before this field

  /// Stored bytes of all pages.
  [[nodiscard]] std::uint64_t stored_page_bytes() const noexcept {
    return std::accumulate(std::begin(stored_bytes), std::end(stored_bytes), std::uint64_t{0});
  }
  /// Kind of a page below page_count.
  [[nodiscard]] PageKind kind_of(std::uint32_t page) const noexcept {
    if (page < first_cap_page()) return PageKind::kDistance;
    if (page < first_field_page()) return PageKind::kCaps;
    if (page < first_attribute_page()) return PageKind::kField;
    return page < first_mask_page() ? PageKind::kAttributes : PageKind::kMask;
  }
  /// Number of the first mask page; page_count if there is none. All pages from it on are mask
  /// pages.
  [[nodiscard]] std::uint32_t first_mask_page() const noexcept {
    return page_count - (model.mask_page_count < page_count ? model.mask_page_count : page_count);
  }
  /// Number of the first attribute page; first_mask_page() if there is none.
  [[nodiscard]] std::uint32_t first_attribute_page() const noexcept {
    const std::uint32_t end = first_mask_page();
    return end - (model.attribute_page_count < end ? model.attribute_page_count : end);
  }
  /// Number of the first field page; first_attribute_page() if there is none.
  [[nodiscard]] std::uint32_t first_field_page() const noexcept {
    const std::uint32_t end = first_attribute_page();
    return end - (model.field_page_count < end ? model.field_page_count : end);
  }
  /// Number of the first cap page; first_field_page() if there is none. All pages before it are
  /// distance pages.
  [[nodiscard]] std::uint32_t first_cap_page() const noexcept {
    const std::uint32_t end = first_field_page();
    return end - (model.cap_page_count < end ? model.cap_page_count : end);
  }
};
static_assert(sizeof(FileHeader) == kHeaderBytes);
static_assert(offsetof(FileHeader, model) == 120);
static_assert(std::is_trivially_copyable_v<FileHeader>);

enum class Codec : std::uint32_t { kStored = 0, kLz4 = 1 };

/// Entry of a page in the directory. The page's octcode is the minimum of those of its subtrees.
/// Distance pages are numbered first, then cap pages, field pages, attribute pages and mask pages,
/// each kind in the order of octcodes.
struct DirectoryPage {
  std::uint64_t check;  ///< XXH3-64 of the stored bytes
  std::uint64_t octcode;
  std::uint32_t stored_bytes;  ///< at least 1; equal to raw_bytes: the raw bytes themselves
  std::uint32_t raw_bytes;     ///< at least 1, at most 255 stored_bytes
};
static_assert(sizeof(DirectoryPage) == 24);

/// Entry of a block of the directory in the block above it.
struct DirectoryBlock {
  std::uint64_t check;    ///< XXH3-64 of the block's bytes
  std::uint64_t octcode;  ///< of the first page below
  std::uint64_t offset;   ///< of the first page below, from page 0 on
};
static_assert(sizeof(DirectoryBlock) == 24);

inline constexpr std::size_t kDirectoryEntryBytes = 24;

/// Where a page is and what it must be.
struct PageEntry {
  std::uint64_t offset;  ///< of the stored bytes in the file
  std::uint64_t check;   ///< XXH3-64 of the stored bytes
  std::uint64_t octcode;
  std::uint32_t stored_bytes;
  std::uint32_t raw_bytes;

  [[nodiscard]] Codec codec() const noexcept {
    return stored_bytes == raw_bytes ? Codec::kStored : Codec::kLz4;
  }
};

inline constexpr std::uint32_t kMaxExtensions = 64;

/// Bytes with a name that a file has besides the model. Records are in the order of names, and no
/// name is there twice.
struct ExtensionRecord {
  char name[24];          ///< a to z, 0 to 9, '.', '-' and '_', at least one; then zeros
  std::uint64_t offset;   ///< in the file
  std::uint64_t bytes;    ///< any number
  std::uint64_t check;    ///< XXH3-64 of the bytes
  std::uint8_t required;  ///< 1: a reader that does not know the name refuses the file
  std::uint8_t reserved[15];
};
static_assert(sizeof(ExtensionRecord) == 64);

}  // namespace planetree::storage
