#include "octree/builder/mesh/ply_vertices.h"

#include <algorithm>

namespace planetree::octree {
namespace {

constexpr std::uint64_t kAtOnceBytes = std::uint64_t{64} << 10;

}  // namespace

PlyVertices::PlyVertices(const MeshFile& file, const PlyHeader& header,
                         const PlyAttributes& attributes, bool swap)
    : file_(file),
      header_(header),
      attributes_(attributes),
      swap_(swap),
      float32_(header.float32()),
      record_bytes_(header.vertices().min_record_bytes()) {
  const ScalarType plain = float32_ ? ScalarType::kFloat32 : ScalarType::kFloat64;
  const auto number_of = [&](std::size_t property) {
    const PlyElement& element = header.vertices();
    return Number{element.offset_of(property), element.properties[property].type};
  };
  plain_ = !swap && record_bytes_ == position_bytes() && attributes.of_vertices == 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    coordinates_[axis] = number_of(header.coordinates[axis]);
    plain_ &=
        coordinates_[axis].type == plain && coordinates_[axis].offset == axis * size_bytes(plain);
  }
  for (const std::size_t property : attributes.vertex_numbers)
    numbers_.push_back(number_of(property));
}

Vec3 PlyVertices::position(const std::byte* record) const {
  const auto& [x, y, z] = coordinates_;
  return {load(record, x), load(record, y), load(record, z)};
}

CornerAttributes PlyVertices::attributes_of(const std::byte* record) const {
  std::array<double, PlyAttributes::kMaxNumbers> numbers;
  for (std::size_t i = 0; i < numbers_.size(); ++i) numbers[i] = load(record, numbers_[i]);
  return vertex_attributes(header_, attributes_, std::span(numbers).first(numbers_.size()));
}

Result<void> PlyVertices::read(std::uint64_t first, std::span<std::byte> out) {
  if (plain_) return file_.read(begin_ + first * record_bytes_, out);
  const std::uint64_t max_records = std::max<std::uint64_t>(kAtOnceBytes / record_bytes_, 1);
  while (!out.empty()) {
    const std::uint64_t count = std::min<std::uint64_t>(max_records, out.size() / record_bytes());
    records_.resize(static_cast<std::size_t>(count * record_bytes_));
    if (const auto read = file_.read(begin_ + first * record_bytes_, records_); !read) return read;
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::byte* const from = records_.data() + i * record_bytes_;
      std::byte* const to = out.data() + i * record_bytes();
      put_position(position(from), float32_, to);
      if (!numbers_.empty())
        put_attributes(attributes_of(from), attributes_.of_vertices, to + position_bytes());
    }
    out = out.subspan(static_cast<std::size_t>(count) * record_bytes());
    first += count;
  }
  return {};
}

}  // namespace planetree::octree
