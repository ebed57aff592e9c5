#include "octree/builder/mesh/stream/face_vertex_join.h"

namespace planetree::octree {

FaceVertexJoin::FaceVertexJoin(MeshVertices& vertices, std::int64_t first_number,
                               MeshScratch& scratch, bool is_text, FanEmitter& emitter)
    : vertices_(vertices),
      vertex_count_(vertices.count()),
      float32_(vertices.float32()),
      first_number_(first_number),
      scratch_(scratch),
      memory_bytes_(scratch.join_bytes(is_text)),
      emitter_(emitter) {}

// The credit has a maximum: a mesh may be in order only at its beginning.
void FaceVertexJoin::begin_face(std::uint64_t corners) {
  const std::uint64_t read_bytes = cache_->read_bytes();
  credit_bytes_ -= std::min(credit_bytes_, read_bytes - seen_bytes_);
  seen_bytes_ = read_bytes;
  const std::uint64_t max_credit = max_credit_bytes();
  credit_bytes_ =
      std::min(credit_bytes_ + kCreditBytes * std::min(corners, max_credit), max_credit);
  limit_bytes_ = read_bytes + credit_bytes_;
}

}  // namespace planetree::octree
