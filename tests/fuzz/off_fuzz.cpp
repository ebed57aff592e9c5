#include "octree/build/off_reader.h"

#include "octree/build/mesh_file.h"
#include "tests/fuzz/mesh_fuzz.h"

/// Any bytes, read as OFF: with a keyword, or as if the name ended in .off.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::octree;
  const MemoryFile memory(bytes, size);
  planetree::Result<MeshFile> file = MeshFile::open(memory.path(), 0);
  if (!file) std::abort();
  CheckingSink sink;
  sink.check(read_off(*file, sink));
  return 0;
}
