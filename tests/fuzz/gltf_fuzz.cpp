#include "octree/builder/mesh/gltf/gltf_reader.h"

#include "octree/builder/mesh/stream/mesh_file.h"
#include "tests/fuzz/mesh_fuzz.h"
#include "tests/fuzz/mesh_mutator.h"

/// Reads arbitrary bytes as glTF, in JSON or binary form, without files beside it. Its size must
/// not be smaller than what is read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::octree;
  const planetree::MemoryFile memory(bytes, size);
  const planetree::Result<MeshFile> file = MeshFile::open(memory.path());
  if (!file) std::abort();
  const auto declared = size_of_gltf(*file);
  read_twice([&](TriangleSink& sink, MeshScratch& scratch) {
    const planetree::Result<MeshSummary> summary =
        read_gltf(*file, "", sink, scratch, keep_of(bytes, size) & kCornerAttributes);
    CheckingSink::expect(!summary ||
                         (declared && declared->triangles >= summary->triangle_indices &&
                          declared->vertices == summary->vertex_records));
    return summary;
  });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return planetree::mutate_mesh(planetree::kGltfGrammar, data, size, max_size, seed);
}
