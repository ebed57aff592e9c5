#include "octree/builder/mesh/stream/face_vertex_join.h"

namespace planetree::octree {

FaceVertexJoin::FaceVertexJoin(MeshVertices& vertices, std::int64_t first_number,
                               MeshScratch& scratch, bool is_text, FanEmitter& emitter,
                               MeshRecords* uvs)
    : vertices_(vertices),
      vertex_count_(vertices.count()),
      float32_(vertices.float32()),
      first_number_(first_number),
      scratch_(scratch),
      uvs_(uvs),
      memory_bytes_(scratch.join_bytes(is_text) / (uvs == nullptr ? 1 : 2)),
      credit_per_corner_(kCreditBytes + attribute_bytes(vertices.attributes()) +
                         (uvs == nullptr ? 0 : uvs->record_bytes())),
      emitter_(emitter),
      has_attributes_((emitter.keep() & kCornerAttributes) != 0) {}

Result<void> FaceVertexJoin::add_uv(CornerSort& sort, std::uint64_t uv_vertex) {
  if (has_uv(uv_vertex)) return sort.add(uv_vertex);
  sort.add_none();
  return {};
}

// The credit has a maximum: a mesh may be in order only at its beginning.
void FaceVertexJoin::begin_face(std::uint64_t corners) {
  const std::uint64_t read_bytes = this->read_bytes();
  credit_bytes_ -= std::min(credit_bytes_, read_bytes - seen_bytes_);
  seen_bytes_ = read_bytes;
  const std::uint64_t max_credit = max_credit_bytes();
  credit_bytes_ =
      std::min(credit_bytes_ + credit_per_corner_ * std::min(corners, max_credit), max_credit);
  limit_bytes_ = read_bytes + credit_bytes_;
}

}  // namespace planetree::octree
