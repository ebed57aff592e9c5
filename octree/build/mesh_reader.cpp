#include "octree/build/mesh_reader.h"

#include <cinttypes>
#include <cstdio>
#include <new>

#include "octree/build/mesh_file.h"
#include "octree/build/mesh_format.h"
#include "octree/build/obj_reader.h"
#include "octree/build/off_reader.h"
#include "octree/build/ply_reader.h"
#include "octree/build/stl_reader.h"

namespace planetree::octree {

namespace {

Result<MeshSummary> read_open(const MeshFile& file, const std::filesystem::path& path,
                              TriangleSink& sink, MeshScratch& scratch) {
  const Result<MeshFormat> format = judge_format(file, path);
  if (!format) return format.error();
  switch (*format) {
    case MeshFormat::kPly:
      return read_ply(file, sink, scratch);
    case MeshFormat::kStlBinary:
      return read_stl_binary(file, sink);
    case MeshFormat::kStlAscii:
      return read_stl_ascii(file, sink);
    case MeshFormat::kOff:
      return read_off(file, sink, scratch);
    case MeshFormat::kObj:
      return read_obj(file, sink, scratch);
    case MeshFormat::kUnknown:
      break;
  }
  return make_error(
      ErrorCode::kBadInput, Error::kNowhere, 0,
      "byte 0: neither a PLY, an STL nor an OFF, and not named .obj; give a PLY, STL, "
      "OBJ or OFF mesh (an OBJ needs its extension)");
}

const char* kind_name(RecordKind kind) {
  switch (kind) {
    case RecordKind::kFace:
      return "face";
    case RecordKind::kFacet:
      return "facet";
    case RecordKind::kLine:
      break;
  }
  return "line";
}

}  // namespace

std::string SetAside::text() const {
  char cause[128] = {};
  switch (fault) {
    case RecordFault::kVertexNotFinite:
      std::snprintf(cause, sizeof cause, "%s %" PRId64 " is not finite",
                    kind == RecordKind::kFacet ? "corner" : "vertex", value);
      break;
    case RecordFault::kIndexOutOfRange:
      std::snprintf(cause, sizeof cause,
                    "vertex index %" PRId64 " is out of range, the file has %" PRIu64 " vertices",
                    value, vertex_count);
      break;
    case RecordFault::kTooFewCorners:
      std::snprintf(cause, sizeof cause, "has %" PRId64 " corners, fewer than 3", value);
      break;
  }
  char line[192] = {};
  std::snprintf(line, sizeof line, "%s %" PRIu64 ": %s", kind_name(kind), record, cause);
  return line;
}

Result<MeshSummary> read_mesh(const std::filesystem::path& path, TriangleSink& sink,
                              MeshScratch& scratch) {
  try {
    const Result<MeshFile> file = MeshFile::open(path, scratch.calls());
    if (!file) return file.error();
    return read_open(*file, path, sink, scratch);
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to read the mesh; free some, or convert it to a binary PLY, "
                      "whose faces need not be in memory");
  }
}

Result<MeshSummary> read_mesh(const std::filesystem::path& path, TriangleSink& sink) {
  MeshScratch scratch;
  return read_mesh(path, sink, scratch);
}

}  // namespace planetree::octree
