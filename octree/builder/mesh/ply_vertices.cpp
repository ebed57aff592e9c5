#include "octree/builder/mesh/ply_vertices.h"

#include <algorithm>

namespace planetree::octree {
namespace {

constexpr std::uint64_t kAtOnceBytes = std::uint64_t{64} << 10;

}  // namespace

PlyVertices::PlyVertices(const MeshFile& file, const PlyHeader& header, bool swap)
    : file_(file),
      swap_(swap),
      float32_(header.float32()),
      record_bytes_(header.vertices().min_record_bytes()) {
  const ScalarType plain = float32_ ? ScalarType::kFloat32 : ScalarType::kFloat64;
  plain_ = !swap && record_bytes_ == position_bytes();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    offsets_[axis] = header.vertices().offset_of(header.coordinates[axis]);
    types_[axis] = header.coordinate_type(axis);
    plain_ &= types_[axis] == plain && offsets_[axis] == axis * size_bytes(plain);
  }
}

Vec3 PlyVertices::position(const std::byte* record) const {
  return {load_real(types_[0], record + offsets_[0], swap_),
          load_real(types_[1], record + offsets_[1], swap_),
          load_real(types_[2], record + offsets_[2], swap_)};
}

Result<void> PlyVertices::read(std::uint64_t first, std::span<std::byte> out) {
  if (plain_) return file_.read(begin_ + first * record_bytes_, out);
  const std::uint64_t max_records = std::max<std::uint64_t>(kAtOnceBytes / record_bytes_, 1);
  while (!out.empty()) {
    const std::uint64_t count = std::min<std::uint64_t>(max_records, out.size() / position_bytes());
    records_.resize(static_cast<std::size_t>(count * record_bytes_));
    if (const auto read = file_.read(begin_ + first * record_bytes_, records_); !read) return read;
    for (std::uint64_t i = 0; i < count; ++i)
      put_position(position(records_.data() + i * record_bytes_), float32_,
                   out.data() + i * position_bytes());
    out = out.subspan(static_cast<std::size_t>(count) * position_bytes());
    first += count;
  }
  return {};
}

}  // namespace planetree::octree
