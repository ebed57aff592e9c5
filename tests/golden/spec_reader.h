#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <span>
#include <string>
#include <vector>

/// A reader of .ptree files written from format-spec/v1/spec.md alone. It shares no code with the
/// implementation, so where both agree the text is right. Simple rather than fast. Faults are
/// thrown as std::runtime_error.
namespace planetree::golden {

using SpecVector = std::array<float, 3>;
using SpecPoint = std::array<double, 3>;

/// A link by page and record ("Links"): the record in bits 0 to 15, the page in bits 16 to 47, and
/// bit 63 is set for a block.
using SpecLink = std::uint64_t;
constexpr SpecLink spec_link(bool is_block, std::uint32_t page, std::uint64_t record) {
  return std::uint64_t{is_block} << 63 | std::uint64_t{page} << 16 | record;
}
constexpr std::uint32_t page_of_link(SpecLink link) {
  return static_cast<std::uint32_t>(link >> 16 & 0xffffffff);
}

/// The fields of "Header" and "Model record" that the reader uses.
struct SpecHeader {
  std::uint32_t page_bytes, page_count;
  std::uint64_t triangle_count, skipped_count, node_count, block_count;
  SpecPoint box_lower, box_upper, core_lower, core_upper, centre, sample;
  std::uint64_t stray_count;
  double stray_edge;
  double openness;
  bool by_surface, side_is_chosen;  ///< side_rule is 1; the writer's user chose it
  bool without_sides;               ///< there is no side layer
  std::uint64_t sample_triangle;
  std::int32_t scale_exponent;
  bool float64, wide_ids;
  unsigned height;
  std::uint64_t mask_cells;
  std::uint32_t mask_pages;
  unsigned mask_levels;
  std::uint64_t input_triangles;     ///< 0: the file has no region
  SpecPoint wall_lower, wall_upper;  ///< walls of the region, model frame; infinite if none
  std::int64_t region_winding;
  std::uint64_t unbalanced_edges, cap_count, cap_node_count, cap_block_count;
  double cap_area;
  std::uint32_t cap_pages;
  unsigned cap_height;
  SpecPoint field_lower;
  double field_step, field_quantum;
  std::array<std::uint32_t, 3> field_size;
  std::uint32_t field_pages, attribute_pages;
  unsigned attributes, value_kind;
  bool has_walls() const;
  /// Links to the roots of the two trees.
  SpecLink root_link() const { return spec_link(node_count == 0, 0, 0); }
  SpecLink cap_root_link() const { return spec_link(cap_node_count == 0, c(), 0); }
  /// Whether the surface is not watertight.
  bool open() const { return cap_count > 0; }
  std::uint64_t field_points() const {
    return std::uint64_t{field_size[0]} * field_size[1] * field_size[2];
  }
  /// Number of indices of the input, those of skipped records included.
  std::uint64_t indices() const {
    return (input_triangles == 0 ? triangle_count : input_triangles) + skipped_count;
  }
  /// Whether the file has the attribute of this bit.
  bool has_attribute(unsigned bit) const { return (attributes >> bit & 1) != 0; }
  /// Triangles of each attribute page but the last. The file has attributes.
  std::uint64_t attribute_page_triangles() const;
  /// Number of the first cap page.
  std::uint32_t c() const { return e() - cap_pages; }
  /// Number of the first field page.
  std::uint32_t e() const { return a() - field_pages; }
  /// Number of the first attribute page.
  std::uint32_t a() const { return d() - attribute_pages; }
  /// Number of the first mask page.
  std::uint32_t d() const { return page_count - mask_pages; }
};

struct SpecBox {
  SpecVector lower, upper;
};

struct SpecDisc {
  SpecVector normal, middle;
  float unit, slab_lower, slab_upper, radius;
};

/// "Moments", relative to the middle of the box.
struct SpecMoments {
  double area, second;
  SpecPoint vector;
  std::array<SpecPoint, 3> first;
};

struct SpecChild {
  SpecBox box;
  SpecDisc disc;
  SpecMoments moments;  ///< of caps only, otherwise zero
  SpecLink link;
};

struct SpecNode {
  SpecBox box;
  unsigned height;
  std::vector<SpecChild> children;
};

struct SpecTriangle {
  std::uint64_t id;
  std::array<SpecPoint, 3> corners;          ///< model frame
  std::array<std::uint32_t, 3> page_vertex;  ///< vertex indices within the page
};

struct SpecBlock {
  std::vector<SpecTriangle> triangles;
  std::size_t vertex_count;
  bool is_height_field;
};

/// A decoded page: records by their links, which are unique in a file.
struct SpecPage {
  std::uint64_t octcode;
  std::uint32_t ordinal;
  std::map<SpecLink, SpecNode> nodes;
  std::map<SpecLink, SpecBlock> blocks;
  std::set<SpecLink> roots;
};

/// An opened file, with header and directory checked.
class SpecFile {
 public:
  explicit SpecFile(std::vector<std::byte> bytes);

  const SpecHeader& header() const { return header_; }
  /// The raw bytes of a page, checked and decompressed.
  std::vector<std::byte> raw_page(std::uint32_t number) const;
  SpecPage page(std::uint32_t number) const;
  /// The bytes of an extension, checked. Empty if the file has none of that name.
  std::string extension(const std::string& name) const;

 private:
  std::span<const std::byte> choose_header() const;
  void check_directory(std::span<const std::byte> header);
  void find_pages(std::span<const std::byte> header);
  void check_keys() const;
  std::span<const std::byte> entry(std::uint32_t number) const;

  std::vector<std::byte> bytes_;
  SpecHeader header_{};
  std::size_t first_entry_ = 0;         // offset of the entry of page 0
  std::vector<std::uint64_t> offsets_;  // of pages
  std::map<std::string, std::string> extensions_;
};

/// "Bounds": decodes stored bounds.
SpecBox decode_box(const SpecBox& parent, const std::array<std::uint8_t, 3>& lower,
                   const std::array<std::uint8_t, 3>& upper);
SpecVector decode_normal(std::int16_t u, std::int16_t v);
float decode_unit(float dx, float dy, float dz);

}  // namespace planetree::golden
