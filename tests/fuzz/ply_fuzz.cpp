#include "tests/fuzz/mesh_fuzz.h"

/// Reads arbitrary bytes as the format they look like. The seeds are PLY files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::octree;
  const MemoryFile file(bytes, size);
  read_twice([&](TriangleSink& sink, MeshScratch& scratch) {
    return read_mesh(file.path(), sink, scratch);
  });
  return 0;
}
