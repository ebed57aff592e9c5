#include "octree/build/mesh_reader.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <new>
#include <string_view>

#include "octree/build/mesh_file.h"
#include "octree/build/obj_reader.h"
#include "octree/build/off_reader.h"
#include "octree/build/ply_reader.h"
#include "octree/build/stl_reader.h"

namespace planetree::octree {

namespace {

enum class MeshFormat { kPly, kStlBinary, kStlAscii, kOff, kObj, kUnknown };

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return extension;
}

MeshFormat judge_format(const MeshFile& file, const std::filesystem::path& path) {
  const std::string_view text = file.text();
  if (is_ply(text)) return MeshFormat::kPly;
  if (has_binary_stl_size(text)) return MeshFormat::kStlBinary;
  if (is_ascii_stl(text)) return MeshFormat::kStlAscii;
  if (is_off(text)) return MeshFormat::kOff;
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return MeshFormat::kObj;
  // One without a keyword, as old ones are.
  if (extension == ".off") return MeshFormat::kOff;
  // A binary STL whose size is wrong: its reader says in which way.
  if (extension == ".stl") return MeshFormat::kStlBinary;
  return MeshFormat::kUnknown;
}

Result<MeshSummary> read_mapped(MeshFile& file, const std::filesystem::path& path,
                                TriangleSink& sink) {
  switch (judge_format(file, path)) {
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
