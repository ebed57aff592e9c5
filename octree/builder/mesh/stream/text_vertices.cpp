#include "octree/builder/mesh/stream/text_vertices.h"

#include <algorithm>

namespace planetree::octree {
namespace {

constexpr std::size_t kAtOnceBytes = std::size_t{64} << 10;

/// No vertex of a text is shorter than the line "0 0 0".
std::uint64_t max_bytes(const MeshFile& file, bool float32) {
  constexpr std::uint64_t kLineBytes = 6;
  return (file.size_bytes() / kLineBytes + 1) * 3 * (float32 ? sizeof(float) : sizeof(double));
}

}  // namespace

TextVertices::TextVertices(const MeshFile& file, bool float32, MeshScratch& scratch)
    : float32_(float32),
      file_(scratch,
            std::min(MeshScratch::text_bytes(scratch.memory_bytes()), max_bytes(file, float32))) {}

Result<void> TextVertices::add(const Vec3& position) {
  const std::size_t at = last_.size();
  last_.resize(at + position_bytes());
  put_position(position, float32_, last_.data() + at);
  ++count_;
  return last_.size() < kAtOnceBytes ? Result<void>() : finish();
}

Result<void> TextVertices::finish() {
  const auto put = file_.spill().append(last_);
  last_.clear();
  if (!put) return put.error();
  return {};
}

Result<void> TextVertices::read(std::uint64_t first, std::span<std::byte> out) {
  return file_.spill().read(first * position_bytes(), out);
}

}  // namespace planetree::octree
