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

Result<MeshSummary> read_mapped(MeshFile& file, const std::filesystem::path& path,
                                TriangleSink& sink) {
  switch (judge_format(file.text(), path)) {
    case MeshFormat::kPly:
      return read_ply(file, sink);
    case MeshFormat::kStlBinary:
      return read_stl_binary(file, sink);
    case MeshFormat::kStlAscii:
      return read_stl_ascii(file, sink);
    case MeshFormat::kOff:
      return read_off(file, sink);
    case MeshFormat::kObj:
      return read_obj(file, sink);
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
                              const MeshReadOptions& options) {
  try {
    Result<MeshFile> file = MeshFile::open(path, options.max_mapped_bytes);
    if (!file) return file.error();
    return read_mapped(*file, path, sink);
  } catch (const std::bad_alloc&) {
    // Only the ascii readers hold vertices in memory.
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory for the mesh's vertices; convert it to a binary PLY, which is "
                      "read without holding them");
  }
}

}  // namespace planetree::octree
