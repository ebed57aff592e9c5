#pragma once

#include <filesystem>

#include "tests/octree/builder/build_fixture.h"
#include "tests/octree/builder/silent_progress.h"

namespace planetree::query {

/// The file of a sphere that is built in many chunks, as large models are. Some of its pages of
/// 4096 bytes have a node or two: the top of a chunk whose other nodes fill other pages.
class ChunkedSphere : public octree::SmallChunks {
 protected:
  explicit ChunkedSphere(unsigned levels, std::uint64_t chunk_triangles = 2000) {
    write(octree::sphere(levels));
    octree::SilentProgress silent;
    octree::BuildOptions options;
    options.page_bytes = 4096;
    const octree::BuildSeams seams{
        chunk_triangles, octree::kSectorTriangles, {}, storage::FileCalls::real()};
    if (!octree::build_tree(mesh_, output_, options, silent, seams)) std::abort();
  }
};

}  // namespace planetree::query
