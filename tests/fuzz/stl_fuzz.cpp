#include "octree/builder/mesh/stl_reader.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "tests/fuzz/mesh_fuzz.h"
#include "tests/fuzz/mesh_mutator.h"

namespace {

using namespace planetree::octree;

template <class Read>
void read_as(const planetree::MemoryFile& memory, const Read& read) {
  const planetree::Result<MeshFile> file = MeshFile::open(memory.path());
  if (!file) std::abort();
  CheckingSink sink;
  sink.check(read(*file, sink));
}

}  // namespace

/// Reads arbitrary bytes directly as binary and as ascii STL, because few inputs have the file size
/// by which read_mesh() detects STL. Then reads them by detection.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  const planetree::MemoryFile memory(bytes, size);
  read_as(memory, read_stl_binary);
  read_as(memory, read_stl_ascii);
  CheckingSink sink;
  sink.check(read_mesh(memory.path(), sink));
  return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  return planetree::mutate_mesh(planetree::kStlGrammar, data, size, max_size, seed);
}
