#include "octree/builder/mesh/mesh_reader.h"

#include <array>
#include <new>
#include <variant>

#include "octree/builder/mesh/gltf/gltf_reader.h"
#include "octree/builder/mesh/mesh_arrays.h"
#include "octree/builder/mesh/mesh_format.h"
#include "octree/builder/mesh/obj/obj_reader.h"
#include "octree/builder/mesh/off_reader.h"
#include "octree/builder/mesh/ply_reader.h"
#include "octree/builder/mesh/sequence/mesh_sequence.h"
#include "octree/builder/mesh/stl_reader.h"
#include "octree/builder/mesh/stream/attribute_names.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/triangle_stream.h"

namespace planetree::octree {
namespace {

/// is_unpacked  whether the file is the content of a compressed one.
Result<MeshSummary> read_open(const MeshFile& file, const std::filesystem::path& path,
                              bool is_unpacked, TriangleSink& sink, MeshScratch& scratch,
                              const MeshOptions& options) {
  const Result<MeshFormat> format = detect_format(file, path);
  if (!format) return format.error();
  switch (*format) {
    case MeshFormat::kPly:
      return read_ply(file, sink, scratch, options);
    case MeshFormat::kStlBinary:
    case MeshFormat::kStlAscii:
      if (const auto refused = refuse_attributes("an STL", options.keep); !refused)
        return refused.error();
      return *format == MeshFormat::kStlBinary ? read_stl_binary(file, sink)
                                               : read_stl_ascii(file, sink);
    case MeshFormat::kOff:
      if (const auto refused = refuse_attributes("an OFF", options.keep); !refused)
        return refused.error();
      return read_off(file, sink, scratch);
    case MeshFormat::kObj:
      return read_obj(file, sink, scratch, options.keep);
    case MeshFormat::kGltf:
      return read_gltf(file, is_unpacked ? std::filesystem::path() : path, sink, scratch,
                       options.keep);
    case MeshFormat::kUnknown:
      break;
  }
  return make_error(
      ErrorCode::kBadInput, Error::kNowhere, 0,
      "byte 0: neither a PLY, an STL, an OFF nor a glTF, and not named .obj; give a PLY, STL, "
      "OBJ, OFF or glTF mesh (an OBJ needs its extension)");
}

/// Passes everything on to a sink. Progress continues after that of the unpacking.
class AfterUnpacking final : public TriangleSink {
 public:
  AfterUnpacking(TriangleSink& sink, std::uint64_t packed_bytes)
      : sink_(sink), packed_bytes_(packed_bytes) {}

  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
    return sink_.triangle(index, corners);
  }
  Result<void> attributes(const TriangleAttributes& attributes) override {
    return sink_.attributes(attributes);
  }
  void skipped(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) override {
    sink_.skipped(first_index, count, why);
  }
  Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override {
    return sink_.progress(packed_bytes_ + bytes_done, packed_bytes_ + bytes_total);
  }

 private:
  TriangleSink& sink_;
  const std::uint64_t packed_bytes_;
};

Result<MeshSummary> read_packed(const MeshFile& packed, Packing packing,
                                const std::filesystem::path& path, TriangleSink& sink,
                                MeshScratch& scratch, const MeshOptions& options) {
  const Result<MeshFile> content = unpack(packed, packing, scratch, sink);
  if (!content) return content.error();
  if (const auto noted = scratch.note_unpacked(*content); !noted) return noted.error();
  AfterUnpacking rest(sink, packed.size_bytes());
  return read_open(*content, unpacked_path(path), true, rest, scratch, options);
}

Result<MeshSummary> read_file(const std::filesystem::path& path, TriangleSink& sink,
                              MeshScratch& scratch, const MeshOptions& options) {
  try {
    const Result<MeshFile> file = MeshFile::open(path, scratch.calls());
    if (!file) return file.error();
    const Result<Packing> packing = detect_packing(*file);
    if (!packing) return packing.error();
    return *packing == Packing::kNone ? read_open(*file, path, false, sink, scratch, options)
                                      : read_packed(*file, *packing, path, sink, scratch, options);
  } catch (const std::bad_alloc&) {
    return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                      "no memory to read the mesh; free some, or convert it to a binary PLY, "
                      "whose faces need not be in memory");
  }
}

// Also finds, before any of them is read, that a file is missing.
Result<std::vector<std::uint64_t>> lengths_of(const std::vector<std::filesystem::path>& paths,
                                              MeshScratch& scratch) {
  std::vector<std::uint64_t> lengths;
  for (const std::filesystem::path& path : paths) {
    scratch.begin_file(path);
    const Result<MeshFile> file = MeshFile::open(path, scratch.calls());
    if (!file) return file.error();
    lengths.push_back(file->size_bytes());
  }
  return lengths;
}

Result<MeshSummary> read_files(const std::vector<std::filesystem::path>& paths, TriangleSink& sink,
                               MeshScratch& scratch, const MeshOptions& options) {
  auto lengths = lengths_of(paths, scratch);
  if (!lengths) return lengths.error();
  MeshSequence sequence(*std::move(lengths), sink);
  for (const std::filesystem::path& path : paths) {
    scratch.begin_file(path);
    sequence.begin_file(path);
    const Result<MeshSummary> summary = read_file(path, sequence, scratch, options);
    if (!summary) return summary;
    if (const auto ended = sequence.end_file(*summary, options.keep); !ended) return ended.error();
  }
  scratch.end_file();
  return sequence.summary();
}

struct Reader {
  Result<MeshSummary> operator()(const std::filesystem::path& path) const {
    scratch.begin_file(path);
    Result<MeshSummary> summary = read_file(path, sink, scratch, options);
    if (!summary) return summary;
    summary->file_indices = {summary->triangle_indices};
    scratch.end_file();
    return summary;
  }
  Result<MeshSummary> operator()(const BuildInput::Files& files) const {
    if (files.paths.empty())
      return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                        "an empty list of mesh files; give at least one");
    return read_files(files.paths, sink, scratch, options);
  }
  Result<MeshSummary> operator()(const BuildInput::Stream& stream) const {
    if (const auto refused = refuse_attributes("a callback", options.keep); !refused)
      return refused.error();
    return read_stream(stream, sink);
  }
  template <class Vertex>
  Result<MeshSummary> operator()(const BuildInput::Mesh<Vertex>& mesh) const {
    return read_arrays(mesh, sink, options.keep & kMeshAttributes);
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
