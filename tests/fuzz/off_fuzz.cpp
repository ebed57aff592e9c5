#include "octree/builder/mesh/off_reader.h"

#include "octree/builder/mesh/stream/mesh_file.h"
#include "tests/fuzz/mesh_fuzz.h"

/// Reads arbitrary bytes as OFF directly: with a keyword, or as if the file name ended in .off.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::octree;
  const MemoryFile memory(bytes, size);
  const planetree::Result<MeshFile> file = MeshFile::open(memory.path());
  if (!file) std::abort();
  read_twice(
      [&](TriangleSink& sink, MeshScratch& scratch) { return read_off(*file, sink, scratch); });
  return 0;
}
