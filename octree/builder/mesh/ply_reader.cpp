#include "octree/builder/mesh/ply_reader.h"

#include <memory>
#include <optional>

#include "octree/builder/mesh/header_prefix.h"
#include "octree/builder/mesh/ply_ascii.h"
#include "octree/builder/mesh/ply_binary.h"
#include "octree/builder/mesh/stream/fan_emitter.h"

namespace planetree::octree {

namespace {

/// Walks the elements in the file's order. Faces in front of the vertices are
/// passed over and read at the end.
Result<void> read_elements(const PlyHeader& header, PlyBody& body) {
  const bool faces_wait = header.face_element < header.vertex_element;
  TextPlace faces_begin;
  TextPlace place = header.body;
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    if (i == header.face_element) faces_begin = place;
    Result<TextPlace> end = i == header.vertex_element ? body.vertices(place)
                            : i == header.face_element && !faces_wait
                                ? body.faces(place)
                                : body.skip(header.elements[i], place);
    if (!end) return end.error();
    place = *end;
  }
  if (Result<void> ended = body.expect_end(place); !ended) return ended;
  if (!faces_wait) return {};
  const Result<TextPlace> end = body.faces(faces_begin);
  if (!end) return end.error();
  return {};
}

}  // namespace

Result<MeshSummary> read_ply(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch) {
  const Result<PlyHeader> header = parse_front(file, parse_ply_header);
  if (!header) return header.error();
  return read_ply_body(file, *header, sink, scratch);
}

Result<MeshSummary> read_ply_body(const MeshFile& file, const PlyHeader& header, TriangleSink& sink,
                                  MeshScratch& scratch) {
  MeshDelivery delivery(sink, RecordKind::kFace, file.size_bytes());
  std::unique_ptr<PlyBody> body;
  if (header.encoding == PlyEncoding::kAscii) {
    body = std::make_unique<PlyAscii>(file, header, delivery, scratch);
  } else {
    body = std::make_unique<PlyBinary>(file, header, delivery, scratch);
  }
  if (Result<void> read = read_elements(header, *body); !read) return read.error();
  return delivery.finish(header.float32());
}

}  // namespace planetree::octree
