#include "octree/builder/mesh/ply_reader.h"

#include <memory>
#include <optional>
#include <utility>

#include "octree/builder/mesh/header_prefix.h"
#include "octree/builder/mesh/ply_ascii.h"
#include "octree/builder/mesh/ply_binary.h"
#include "octree/builder/mesh/stream/fan_emitter.h"
#include "octree/builder/mesh/stream/mesh_lines.h"

namespace planetree::octree {

namespace {

/// Reads the elements in the file's order. Faces in front of the vertices are read at the end.
Result<void> read_elements(const PlyHeader& header, PlyBody& body) {
  const bool faces_come_first = header.face_element < header.vertex_element;
  TextPosition faces_begin;
  TextPosition position = header.body;
  for (std::size_t i = 0; i < header.elements.size(); ++i) {
    if (i == header.face_element) faces_begin = position;
    Result<TextPosition> end = i == header.vertex_element ? body.vertices(position)
                               : i == header.face_element && !faces_come_first
                                   ? body.faces(position)
                                   : body.skip(header.elements[i], position);
    if (!end) return end.error();
    position = *end;
  }
  if (Result<void> ended = body.expect_end(position); !ended) return ended;
  if (!faces_come_first) return {};
  const Result<TextPosition> end = body.faces(faces_begin);
  if (!end) return end.error();
  return {};
}

}  // namespace

Result<MeshSummary> read_ply(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch,
                             const MeshOptions& options) {
  Result<PlyHeader> header = parse_prefix(file, parse_ply_header);
  if (!header) return header.error();
  if (options.float64) header->widen_text();
  const auto attributes = find_attributes(*header, options.keep, options.value_property);
  if (!attributes) return attributes.error();
  return read_ply_body(file, *header, sink, scratch, *attributes);
}

Result<MeshSummary> read_ply_body(const MeshFile& file, const PlyHeader& header, TriangleSink& sink,
                                  MeshScratch& scratch, const PlyAttributes& attributes) {
  FanEmitter emitter(sink, RecordKind::kFace, file.size_bytes());
  emitter.set_keep(attributes.keep);
  std::unique_ptr<PlyBody> body;
  if (header.encoding == PlyEncoding::kAscii) {
    body = std::make_unique<PlyAscii>(file, header, attributes, emitter, scratch);
  } else {
    body = std::make_unique<PlyBinary>(file, header, attributes, emitter, scratch);
  }
  if (Result<void> read = read_elements(header, *body); !read) return read.error();
  Result<MeshSummary> summary = emitter.finish(header.float32());
  if (summary) {
    summary->value_kind = attributes.value_kind;
    summary->notes = body->notes();
  }
  return header.encoding == PlyEncoding::kAscii ? with_note_of_padding(file, std::move(summary))
                                                : summary;
}

}  // namespace planetree::octree
