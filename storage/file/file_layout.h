#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

/// The bytes of a .ptree file outside its pages, as format-spec/v1/spec.md
/// states them in "Header", "Model record" and "Page table". All integers and
/// floats are little-endian; a struct here is the bytes there.
///
///   0                      header          kHeaderBytes
///   kHeaderBytes           page table      page_count * sizeof(PageEntry)
///   ...                    pages           stored bytes, page 0 first, no gap:
///                                          distance pages, then mask pages
///   file_bytes - 576       header again    the same kHeaderBytes bytes
namespace planetree::storage {

static_assert(std::endian::native == std::endian::little,
              "planetree reads and writes its structs in place: little-endian machines only");

inline constexpr std::uint8_t kMagic[8] = {0x89, 'P', 'T', 'R', 'E', 'E', 0x0d, 0x0a};
inline constexpr std::uint16_t kFormatVersion = 10;
inline constexpr std::size_t kHeaderBytes = 576;
inline constexpr std::uint64_t kKnownIncompatibleFeatures = 0;
inline constexpr std::uint32_t kMinPageBytes = 4096;
inline constexpr std::uint32_t kMaxPageBytes = 262144;
inline constexpr std::uint64_t kNoTriangle = ~std::uint64_t{0};

enum class VertexKind : std::uint8_t { kFloat32 = 0, kFloat64 = 1 };

/// An edge along which as many faces do not run one way as the other.
struct UnbalancedEdge {
  double from[3];          ///< input coordinates, exact: the edge as `triangle` runs along it
  double to[3];            ///< input coordinates, exact
  std::uint64_t triangle;  ///< the least index of a triangle that has it
  std::uint32_t along;     ///< triangles that run from `from` to `to`
  std::uint32_t against;   ///< triangles that run the other way
};
static_assert(sizeof(UnbalancedEdge) == 64);

/// What the whole model is. "Model frame" is the input's coordinates times
/// 2^scale_exponent, so that the longest box edge lies in [1, 2).
struct ModelRecord {
  std::uint64_t triangle_count;         ///< triangles that answer: of the region, if there is one
  std::uint64_t skipped_count;          ///< triangles of bad input records, which do not
  std::uint64_t first_skipped;          ///< the first such triangle's index, or kNoTriangle
  std::uint64_t vertex_count;           ///< vertex records of the input
  std::uint64_t node_count;             ///< inner nodes of the distance tree
  std::uint64_t block_count;            ///< triangle blocks of the distance tree
  double box_lower[3];                  ///< of the whole input: its coordinates, exact
  double box_upper[3];                  ///< likewise
  double centre[3];                     ///< model frame; boxes and planes are relative to it
  double sample[3];                     ///< model frame; a vertex of sample_triangle
  std::uint64_t sample_triangle;        ///< the least index of a triangle that answers
  std::int32_t scale_exponent;          ///< model frame = input * 2^scale_exponent
  std::uint32_t root_link;              ///< link to the tree's root, a node or a block
  VertexKind vertex_kind;               ///< width of stored coordinates
  std::uint8_t triangle_id_bytes;       ///< width of stored triangle indices: 4 or 8
  std::uint8_t height;                  ///< most nodes on a path from root to block
  std::uint8_t reserved[5];             ///< zero
  std::uint64_t unbalanced_edge_count;  ///< of the whole input; 0: the surface is watertight
  UnbalancedEdge unbalanced_edge[3];    ///< the first, by triangle, then corner; else zero
  std::uint64_t mask_cell_count;        ///< grey cells of the mask
  std::uint32_t mask_page_count;        ///< the last pages of the file; 0: there is no mask
  std::uint8_t mask_levels;             ///< level of the finest grey cell
  std::uint8_t mask_reserved[3];        ///< zero
  /// Of a file that holds only what touches a region: how many triangles of the input could be
  /// used. 0: the file is of the whole input, and what follows is zero.
  std::uint64_t input_triangles;
  double region_lower[3];       ///< the input's units
  double region_upper[3];       ///< likewise
  std::int64_t region_winding;  ///< winding number at the least corner of the mask's root

  [[nodiscard]] bool has_region() const noexcept { return input_triangles > 0; }
  /// Of the whole input.
  [[nodiscard]] std::uint64_t usable_triangles() const noexcept {
    return has_region() ? input_triangles : triangle_count;
  }
};
static_assert(sizeof(ModelRecord) == 448);

struct FileHeader {
  std::uint8_t magic[8];                ///< kMagic
  std::uint16_t version;                ///< kFormatVersion
  std::uint16_t header_bytes;           ///< kHeaderBytes
  std::uint32_t page_bytes;             ///< bytes of a decoded page; a power of two
  std::uint64_t incompatible_features;  ///< an unknown bit: refuse the file
  std::uint64_t compatible_features;    ///< an unknown bit: go on
  std::uint64_t file_bytes;             ///< exact length of the file
  std::uint64_t content_id[2];          ///< XXH3-128 of the page hashes, low word first
  std::uint64_t table_hash;             ///< XXH3-64 of the page table's bytes
  std::uint32_t page_count;             ///< at least 1
  std::uint32_t max_raw_bytes;          ///< largest PageEntry::raw_bytes
  std::uint64_t max_stored_bytes;       ///< largest PageEntry::stored_bytes
  ModelRecord model;
  std::uint8_t reserved[40];  ///< zero
  std::uint64_t header_hash;  ///< XXH3-64 of all bytes before it

  /// Pages before it are distance pages, it and those behind it mask pages.
  [[nodiscard]] std::uint32_t first_mask_page() const noexcept {
    return page_count - (model.mask_page_count < page_count ? model.mask_page_count : page_count);
  }
};
static_assert(sizeof(FileHeader) == kHeaderBytes);
static_assert(offsetof(FileHeader, model) == 80);
static_assert(std::is_trivially_copyable_v<FileHeader>);

enum class Codec : std::uint32_t { kStored = 0, kLz4 = 1 };

/// One page. Its key is the least octcode of its subtrees, and an ordinal among pages of that
/// octcode; its number is the key's rank among the pages of its kind, those of the mask last.
struct PageEntry {
  std::uint64_t offset;        ///< of the stored bytes in the file
  std::uint64_t check;         ///< XXH3-64 of the stored bytes seeded with the page number,
                               ///< exclusive-or content_id[0]
  std::uint64_t octcode;       ///< key, first part
  std::uint32_t ordinal;       ///< key, second part
  Codec codec;                 ///< how raw bytes became stored bytes
  std::uint32_t stored_bytes;  ///< at least 1
  std::uint32_t raw_bytes;     ///< at least 1; stored_bytes >= raw_bytes / 255
};
static_assert(sizeof(PageEntry) == 40);

}  // namespace planetree::storage
