#include "octree/builder/mesh/mesh_reader.h"

#include <new>
#include <variant>

#include "octree/builder/mesh/mesh_arrays.h"
#include "octree/builder/mesh/mesh_format.h"
#include "octree/builder/mesh/obj_reader.h"
#include "octree/builder/mesh/off_reader.h"
#include "octree/builder/mesh/ply_reader.h"
#include "octree/builder/mesh/stl_reader.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/triangle_stream.h"

namespace planetree::octree {
namespace {

Result<MeshSummary> read_open(const MeshFile& file, const std::filesystem::path& path,
                              TriangleSink& sink, MeshScratch& scratch,
                              const MeshOptions& options) {
  const Result<MeshFormat> format = detect_format(file, path);
  if (!format) return format.error();
  switch (*format) {
    case MeshFormat::kPly:
      return read_ply(file, sink, scratch, options);
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

Result<MeshSummary> read_file(const std::filesystem::path& path, TriangleSink& sink,
                              MeshScratch& scratch, const MeshOptions& options) {
  try {
    const Result<MeshFile> file = MeshFile::open(path, scratch.calls());
    if (!file) return file.error();
    return read_open(*file, path, sink, scratch, options);
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to read the mesh; free some, or convert it to a binary PLY, "
                      "whose faces need not be in memory");
  }
}

struct Reader {
  Result<MeshSummary> operator()(const std::filesystem::path& path) const {
    return read_file(path, sink, scratch, options);
  }
  Result<MeshSummary> operator()(const BuildInput::Stream& stream) const {
    return read_stream(stream, sink);
  }
  template <class Vertex>
  Result<MeshSummary> operator()(const BuildInput::Mesh<Vertex>& mesh) const {
    return read_arrays(mesh, sink);
  }
  TriangleSink& sink;
  MeshScratch& scratch;
  const MeshOptions& options;
};

}  // namespace

Result<MeshSummary> read_mesh(const BuildInput& input, TriangleSink& sink, MeshScratch& scratch,
                              const MeshOptions& options) {
  return std::visit(Reader{sink, scratch, options}, input.content());
}

Result<MeshSummary> read_mesh(const BuildInput& input, TriangleSink& sink) {
  MeshScratch scratch;
  return read_mesh(input, sink, scratch);
}

}  // namespace planetree::octree
