#include "octree/builder/mesh/stream/packing.h"

#include "octree/builder/mesh/mesh_format.h"
#include "octree/builder/mesh/mesh_reader.h"
#include "tests/fuzz/mesh_fuzz.h"

/// Reads arbitrary bytes as a compressed mesh. Input that names no packing is taken as gzip data
/// without its first bytes. Long inputs are left out, as their content may be very long.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::octree;
  if (size > 1024) return 0;
  std::string text(reinterpret_cast<const char*>(bytes), size);
  if (packing_of(text) == Packing::kNone) text.insert(0, "\x1f\x8b\x08");
  const planetree::MemoryFile memory(reinterpret_cast<const std::uint8_t*>(text.data()),
                                     text.size());
  CheckingSink sink;
  MeshScratch scratch(std::uint64_t{1} << 20, "/dev/shm");
  const auto summary = read_mesh(memory.path(), sink, scratch);
  // A frame behind the first may need a larger window than there is memory for.
  const bool needs_memory = !summary && summary.error().code == planetree::ErrorCode::kNoMemory;
  if (!needs_memory) sink.check(summary);
  return 0;
}
