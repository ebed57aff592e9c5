#include "tests/golden/spec_page.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/golden/spec_streams.h"

namespace planetree::golden {
namespace {

struct Head {
  std::uint32_t page_number, ordinal;
  std::uint64_t octcode;
  std::uint16_t nodes, blocks, roots, children, page_links;
  std::uint16_t vertices, vertex_refs, triangles, reserved[4];
};
static_assert(sizeof(Head) == 40);

class PageReader {
 public:
  PageReader(std::span<const std::byte> raw, std::uint32_t number, const SpecHeader& header)
      : header_(header), number_(number), of_caps_(number >= header.c()), layout_(raw) {
    std::memcpy(&head_, layout_.bytes(40).data(), 40);
    require(head_.page_number == number, "another page");
  }

  SpecPage read() {
    cut_node_streams();
    cut_block_streams();
    require(layout_.empty(), "the page is too long");
    require_capacity();
    SpecPage page{head_.octcode, head_.ordinal, {}, {}, {}};
    read_nodes(page);
    for (std::size_t j = 0; j < head_.blocks; ++j) page.blocks[block_link(j)] = read_block(j);
    for (std::size_t i = 0; i < head_.roots; ++i) page.roots.insert(node_link(i));
    if (head_.nodes == 0) page.roots.insert(block_link(0));
    return page;
  }

 private:
  void cut_node_streams() {
    root_boxes_ = layout_.byte_split<float>(6u * head_.roots);
    child_counts_ = layout_.byte_split<std::uint8_t>(head_.nodes);
    heights_ = layout_.byte_split<std::uint8_t>(head_.nodes);
    kinds_ = layout_.byte_split<std::uint16_t>(head_.nodes);
    boxes_ = layout_.byte_split<std::uint8_t>(6u * head_.children);
    normals_ = layout_.byte_split<std::int16_t>(2u * head_.children);
    slabs_ = layout_.byte_split<std::int16_t>(2u * head_.children);
    radii_ = layout_.byte_split<std::uint16_t>(head_.children);
    if (of_caps_) {
      vectors_ = layout_.byte_split<std::int16_t>(3u * head_.children);
      firsts_ = layout_.byte_split<std::int8_t>(5u * head_.children);
      areas_ = layout_.byte_split<std::uint16_t>(head_.children);
      seconds_ = layout_.byte_split<std::uint16_t>(head_.children);
    }
    linked_pages_ = layout_.byte_split<std::uint32_t>(head_.page_links);
    linked_nodes_ = layout_.byte_split<std::uint16_t>(head_.page_links);
  }

  void cut_block_streams() {
    triangle_counts_ = layout_.byte_split<std::uint8_t>(head_.blocks);
    for (std::uint8_t& count : triangle_counts_) {
      is_height_field_.push_back(count >> 7 != 0);
      compact_.push_back((count >> 6 & 1) != 0);
      count &= 0x3f;
    }
    require((!of_caps_ && !header_.has_walls() && !header_.without_sides) ||
                std::ranges::count(is_height_field_, true) == 0,
            "a height field of caps or of a region with walls");
    vertex_counts_ = layout_.byte_split<std::uint8_t>(head_.blocks);
    new_counts_ = layout_.byte_split<std::uint8_t>(head_.blocks);
    vertex_refs_ = layout_.byte_split<std::uint16_t>(head_.vertex_refs);
    for (std::size_t j = 0; j < head_.blocks; ++j)
      corners_.push_back(layout_.bytes((3u * triangle_counts_[j] * corner_bits(j) + 7) / 8));
    vertices_ = layout_.either<float, double>(header_.float64, 3u * head_.vertices);
    first_ids_ = layout_.either<std::uint32_t, std::uint64_t>(header_.wide_ids, head_.blocks);
    const std::size_t steps = std::size_t{head_.triangles} - head_.blocks;
    id_steps_ = layout_.either<std::uint32_t, std::uint64_t>(header_.wide_ids, steps);
  }

  unsigned corner_bits(std::size_t block) const {
    return vertex_counts_[block] <= 16 ? 4 : vertex_counts_[block] <= 32 ? 5 : 6;
  }

  std::uint32_t block_weight(std::size_t block) const {
    const unsigned v = vertex_counts_[block];
    const std::size_t row = v <= 16 ? 0 : v <= 24 ? 1 : v <= 32 ? 2 : 3;
    constexpr std::uint32_t kWeights[4][2] = {{5, 11}, {7, 16}, {8, 20}, {11, 29}};
    return kWeights[row][header_.float64] + (header_.wide_ids ? 1 : 0) - (compact_[block] ? 1 : 0);
  }

  SpecLink node_link(std::size_t i) const { return spec_link(false, number_, i); }
  SpecLink block_link(std::size_t j) const { return spec_link(true, number_, j); }

  std::uint32_t node_weight() const { return of_caps_ ? 7 : 5; }
  // "Capacity of a distance page".
  std::uint32_t capacity() const {
    return header_.page_bytes / 64 - 1 - (header_.page_bytes + 8191) / 8192;
  }
  void require_capacity() const {
    std::uint32_t weight = head_.nodes * node_weight();
    for (std::size_t j = 0; j < head_.blocks; ++j) weight += block_weight(j);
    require(weight <= capacity(), "the records do not fit");
  }

  void read_nodes(SpecPage& page) {
    require(head_.nodes > 0 || (head_.blocks == 1 && pages_of_tree() == 1), "a lone block");
    require((head_.roots > 0) == (head_.nodes > 0), "roots");
    std::vector<SpecBox> boxes(head_.nodes);
    for (std::size_t i = 0; i < head_.roots; ++i)
      std::memcpy(&boxes[i], &root_boxes_[6 * i], sizeof(SpecBox));
    std::size_t child = 0, next_node = head_.roots, next_block = head_.nodes == 0 ? 1 : 0;
    std::size_t next_link = 0;
    for (std::size_t i = 0; i < head_.nodes; ++i) {
      require(i < next_node, "a node without a parent");
      SpecNode node{boxes[i], heights_[i], {}};
      for (unsigned c = 0; c < child_counts_[i]; ++c, ++child) {
        SpecChild read = read_child(boxes[i], child);
        const unsigned kind = kinds_[i] >> (2 * c) & 3;
        require(kind < 3, "kind of a child");
        if (kind == 0) boxes.at(next_node) = read.box;
        read.link = kind == 0   ? node_link(next_node++)
                    : kind == 1 ? block_link(next_block++)
                                : page_link(next_link++);
        node.children.push_back(read);
      }
      page.nodes[node_link(i)] = node;
    }
    require(child == head_.children && next_node == head_.nodes && next_block == head_.blocks &&
                next_link == head_.page_links,
            "children do not add up");
  }

  std::uint32_t pages_of_tree() const { return of_caps_ ? header_.e() - header_.c() : header_.c(); }

  SpecLink page_link(std::size_t at) const {
    const std::uint32_t page = linked_pages_.at(at);
    require(number_ < page && page < (of_caps_ ? header_.e() : header_.c()), "a page link");
    require(linked_nodes_.at(at) < capacity() / node_weight(), "a linked node");
    return spec_link(false, page, linked_nodes_.at(at));
  }

  SpecChild read_child(const SpecBox& parent, std::size_t child) const {
    const std::size_t n = head_.children;
    const auto plane = [&](std::size_t k) { return boxes_[k * n + child]; };
    SpecChild read{};
    read.box = decode_box(parent, {plane(0), plane(1), plane(2)}, {plane(3), plane(4), plane(5)});
    SpecDisc& disc = read.disc;
    SpecVector edge{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      edge[axis] = read.box.upper[axis] - read.box.lower[axis];
      disc.middle[axis] = (read.box.lower[axis] + read.box.upper[axis]) * 0.5f;
    }
    disc.normal = decode_normal(normals_[child], normals_[n + child]);
    disc.unit = decode_unit(edge[0], edge[1], edge[2]);
    disc.slab_lower = static_cast<float>(slabs_[child]) * disc.unit;
    disc.slab_upper = static_cast<float>(slabs_[n + child]) * disc.unit;
    disc.radius = static_cast<float>(radii_[child]) * disc.unit;
    if (of_caps_) read.moments = read_moments(child);
    return read;
  }

  SpecMoments read_moments(std::size_t child) const {
    const std::size_t n = head_.children;
    SpecMoments read{};
    for (const std::uint16_t bits : {areas_[child], seconds_[child]})
      require(bits >= 0x0080 && bits <= 0x7f7f, "moments");
    read.area = upper_half(areas_[child]);
    read.second = upper_half(seconds_[child]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      read.vector[axis] = read.area / 32767 * vectors_[axis * n + child];
    const auto step = [&](std::size_t k) -> double { return firsts_[k * n + child]; };
    const double xx = step(0), yy = step(1), xy = step(2), yz = step(3), zx = step(4);
    read.first = {{{xx, xy, zx}, {xy, yy, yz}, {zx, yz, -xx - yy}}};
    for (SpecPoint& row : read.first)
      for (double& part : row) part *= std::sqrt(read.area * read.second) / 127;
    return read;
  }

  static double upper_half(std::uint16_t bits) {
    const std::uint32_t whole = std::uint32_t{bits} << 16;
    float value;
    std::memcpy(&value, &whole, sizeof value);
    return static_cast<double>(value);
  }

  SpecBlock read_block(std::size_t block) {
    std::vector<std::uint32_t> vertices;
    const std::size_t old_count = vertex_counts_[block] - new_counts_[block];
    for (std::size_t i = 0; i < old_count; ++i)
      vertices.push_back((i == 0 ? 0 : vertices.back()) + vertex_refs_.at(next_ref_++));
    while (vertices.size() < vertex_counts_[block]) vertices.push_back(next_vertex_++);
    SpecBlock read{{}, vertices.size(), is_height_field_[block]};
    std::uint64_t id = first_ids_[block];
    for (std::size_t i = 0; i < triangle_counts_[block]; ++i) {
      if (i > 0) id += id_steps_.at(next_step_++);
      SpecTriangle triangle{id, {}, {}};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t vertex = vertices.at(corner(block, 3 * i + k));
        triangle.page_vertex[k] = vertex;
        for (std::size_t axis = 0; axis < 3; ++axis)
          triangle.corners[k][axis] = vertices_.at(axis * head_.vertices + vertex);
      }
      read.triangles.push_back(triangle);
    }
    const bool compact = !header_.float64 && !header_.wide_ids && vertex_counts_[block] <= 16 &&
                         id - first_ids_[block] <= 65535;
    require(compact_[block] == compact, "a block that is compact, or the bit that says so");
    return read;
  }

  // Bits count from the lowest of each byte.
  std::size_t corner(std::size_t block, std::size_t index) const {
    const unsigned bits = corner_bits(block);
    std::size_t value = 0;
    for (unsigned b = 0; b < bits; ++b) {
      const std::size_t at = index * bits + b;
      const auto byte = static_cast<unsigned>(corners_[block][at / 8]);
      value |= static_cast<std::size_t>(byte >> at % 8 & 1) << b;
    }
    return value;
  }

  const SpecHeader& header_;
  std::uint32_t number_;
  bool of_caps_;
  StreamReader layout_;
  Head head_{};
  std::vector<float> root_boxes_;
  std::vector<std::uint8_t> child_counts_, heights_, boxes_;
  std::vector<std::uint8_t> triangle_counts_, vertex_counts_, new_counts_;
  std::vector<bool> is_height_field_, compact_;
  std::vector<std::uint16_t> kinds_, radii_, areas_, seconds_, vertex_refs_;
  std::vector<std::int16_t> normals_, slabs_, vectors_;
  std::vector<std::int8_t> firsts_;
  std::vector<std::uint32_t> linked_pages_;
  std::vector<std::uint16_t> linked_nodes_;
  std::vector<std::span<const std::byte>> corners_;
  std::vector<double> vertices_;
  std::vector<std::uint64_t> first_ids_, id_steps_;
  std::size_t next_ref_ = 0, next_step_ = 0;
  std::uint32_t next_vertex_ = 0;
};

}  // namespace

SpecPage decode_spec_page(std::span<const std::byte> raw, std::uint32_t number,
                          const SpecHeader& header) {
  return PageReader(raw, number, header).read();
}

SpecBox decode_box(const SpecBox& parent, const std::array<std::uint8_t, 3>& lower,
                   const std::array<std::uint8_t, 3>& upper) {
  SpecBox box{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const float low = parent.lower[axis], high = parent.upper[axis];
    const float step = (high - low) * (1.0f / 255);
    box.lower[axis] = low + static_cast<float>(lower[axis]) * step;
    box.upper[axis] = high - static_cast<float>(upper[axis]) * step;
  }
  return box;
}

SpecVector decode_normal(std::int16_t u, std::int16_t v) {
  float x = std::max(static_cast<float>(u) / 32767, -1.0f);
  float y = std::max(static_cast<float>(v) / 32767, -1.0f);
  const float z = (1 - std::fabs(x)) - std::fabs(y);
  if (z < 0) {
    const float old_x = x;
    x = (1 - std::fabs(y)) * (x < 0 ? -1.0f : 1.0f);
    y = (1 - std::fabs(old_x)) * (y < 0 ? -1.0f : 1.0f);
  }
  const float length = std::sqrt((x * x + y * y) + z * z);
  return {x / length, y / length, z / length};
}

float decode_unit(float dx, float dy, float dz) {
  return std::sqrt((dx * dx + dy * dy) + dz * dz) * (1.0f / 32000);
}

}  // namespace planetree::golden
