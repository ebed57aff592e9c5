#include "tests/fuzz/mesh_fuzz.h"
#include "tests/fuzz/mesh_mutator.h"

/// Reads arbitrary bytes as the format they look like. The seeds are PLY files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::octree;
  const planetree::MemoryFile file(bytes, size);
  read_twice([&](TriangleSink& sink, MeshScratch& scratch) {
    return read_mesh(file.path(), sink, scratch, {.keep = keep_of(bytes, size)});
  });
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return planetree::mutate_mesh(planetree::kPlyGrammar, data, size, max_size, seed);
}
