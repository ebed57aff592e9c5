#include "tests/octree/builder/chunked_tree.h"

#include <cstdlib>

namespace planetree::octree {

ChunkedTree::ChunkedTree(const Soup& soup, std::uint64_t chunk_triangles, std::uint32_t page_bytes,
                         storage::SpillFile& file)
    : mesh(store(soup)),
      runs(runs_of(mesh)),
      above(*cut_chunks(*runs, mesh.frame.stray_count > 0, chunk_triangles)) {
  shape.float64 = mesh.float64();
  for (const Chunk& chunk : above.chunks) {
    Triangles triangles = *runs->read(chunk.from, chunk.to);
    auto built = build_chunk(triangles, above.chunks.size() == 1, mesh.frame.centre(), shape,
                             page_bytes, file);
    if (!built) std::abort();
    chunks.push_back(*std::move(built));
  }
  tree = std::make_unique<BuiltTree>(mesh.frame, above, chunks, shape, page_bytes, file);
}

}  // namespace planetree::octree
