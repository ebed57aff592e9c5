#include "octree/builder/tree/block_encoder.h"

#include <algorithm>
#include <cassert>

namespace planetree::octree {
namespace {

// Packs bits, lowest first. flush() fills up the last byte.
class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& bytes) : bytes_(bytes) {}
  void put(unsigned value, unsigned bits) {
    window_ |= value << held_;
    for (held_ += bits; held_ >= 8; held_ -= 8, window_ >>= 8)
      bytes_.push_back(static_cast<std::byte>(window_));
  }
  void flush() {
    if (held_ > 0) bytes_.push_back(static_cast<std::byte>(window_));
    window_ = held_ = 0;
  }

 private:
  std::vector<std::byte>& bytes_;
  unsigned window_ = 0;
  unsigned held_ = 0;
};

template <class To, class From>
std::vector<To> narrowed(const std::vector<From>& values) {
  std::vector<To> result(values.size());
  std::transform(values.begin(), values.end(), result.begin(),
                 [](From value) { return static_cast<To>(value); });
  return result;
}

}  // namespace

std::vector<std::uint32_t> BlockEncoder::sorted_positions(const WideBlock& block) const {
  std::vector<std::uint32_t> positions;
  for (std::uint32_t i = block.begin; i < block.end; ++i) positions.push_back(keys_[i].position);
  std::sort(positions.begin(), positions.end(),
            [this](std::uint32_t a, std::uint32_t b) { return mesh_.index(a) < mesh_.index(b); });
  return positions;
}

void BlockEncoder::add(const WideBlock& block) {
  const std::vector<std::uint32_t> positions = sorted_positions(block);
  const auto had = static_cast<std::uint32_t>(vertices_.size());
  std::vector<std::uint32_t> vertices;
  Corners corners;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::array<std::uint32_t, 3>& of_triangle = of_chunk_.corners(positions[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto next = static_cast<std::uint32_t>(vertices_.size());
      const auto [at, is_new] = vertex_of_.try_emplace(of_triangle[k], next);
      if (is_new) vertices_.push_back(of_triangle[k]);
      corners[i][k] = at->second;
      vertices.push_back(at->second);
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  std::uint32_t previous = 0;
  for (const std::uint32_t vertex : vertices) {
    if (vertex >= had) break;
    vertex_refs_.push_back(static_cast<std::uint16_t>(vertex - previous));
    previous = vertex;
  }
  const bool compact =
      shape_.is_compact(static_cast<unsigned>(vertices.size()),
                        mesh_.index(positions.back()) - mesh_.index(positions.front()));
  triangle_counts_.push_back(
      static_cast<std::uint8_t>(positions.size() | (compact ? kCompactBit : 0U)));
  vertex_counts_.push_back(static_cast<std::uint8_t>(vertices.size()));
  new_counts_.push_back(static_cast<std::uint8_t>(vertices_.size() - had));
  add_corners(corners, positions.size(), vertices);
  add_ids(positions);
}

void BlockEncoder::add_corners(const Corners& corners, std::size_t count,
                               const std::vector<std::uint32_t>& vertices) {
  const unsigned bits = corner_bits(static_cast<unsigned>(vertices.size()));
  BitWriter writer(corners_);
  for (std::size_t i = 0; i < count; ++i)
    for (const std::uint32_t vertex : corners[i]) {
      const auto at = std::lower_bound(vertices.begin(), vertices.end(), vertex);
      writer.put(static_cast<unsigned>(at - vertices.begin()), bits);
    }
  writer.flush();
}

void BlockEncoder::add_ids(const std::vector<std::uint32_t>& positions) {
  std::uint64_t previous = mesh_.index(positions[0]);
  first_ids_.push_back(previous);
  for (std::size_t i = 1; i < positions.size(); ++i) {
    const std::uint64_t id = mesh_.index(positions[i]);
    id_steps_.push_back(id - previous);
    previous = id;
  }
}

void BlockEncoder::describe(PageHead& head) const {
  assert(vertices_.size() <= 0xffff && triangle_counts_.size() <= 0xffff);
  head.block_count = static_cast<std::uint16_t>(triangle_counts_.size());
  head.vertex_count = static_cast<std::uint16_t>(vertices_.size());
  head.vertex_ref_count = static_cast<std::uint16_t>(vertex_refs_.size());
  head.triangle_count = static_cast<std::uint16_t>(first_ids_.size() + id_steps_.size());
}

std::vector<double> BlockEncoder::coordinates_by_axis() const {
  std::vector<double> coordinates;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    for (const std::uint32_t vertex : vertices_) coordinates.push_back(of_chunk_[vertex][axis]);
  return coordinates;
}

void BlockEncoder::write(StreamWriter& writer) const {
  writer.byte_split(triangle_counts_);
  writer.byte_split(vertex_counts_);
  writer.byte_split(new_counts_);
  writer.byte_split(vertex_refs_);
  writer.plain(corners_.data(), corners_.size());
  if (shape_.float64)
    writer.byte_split(coordinates_by_axis());
  else
    writer.byte_split(narrowed<float>(coordinates_by_axis()));
  if (shape_.wide_ids) {
    writer.byte_split(first_ids_);
    writer.byte_split(id_steps_);
  } else {
    writer.byte_split(narrowed<std::uint32_t>(first_ids_));
    writer.byte_split(narrowed<std::uint32_t>(id_steps_));
  }
}

}  // namespace planetree::octree
