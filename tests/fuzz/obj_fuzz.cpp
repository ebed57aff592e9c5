#include "octree/builder/mesh/obj/obj_reader.h"

#include "octree/builder/mesh/stream/mesh_file.h"
#include "tests/fuzz/mesh_fuzz.h"
#include "tests/fuzz/mesh_mutator.h"

/// Reads arbitrary bytes as OBJ directly: the name of a file in memory does not end in .obj.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::octree;
  const planetree::MemoryFile memory(bytes, size);
  const planetree::Result<MeshFile> file = MeshFile::open(memory.path());
  if (!file) std::abort();
  read_twice([&](TriangleSink& sink, MeshScratch& scratch) {
    return read_obj(*file, sink, scratch, keep_of(bytes, size) & kCornerAttributes);
  });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return planetree::mutate_mesh(planetree::kObjGrammar, data, size, max_size, seed);
}
