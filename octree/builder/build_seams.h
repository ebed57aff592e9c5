#pragma once

#include <cstdint>
#include <optional>

#include "octree/builder/job/build_memory.h"
#include "octree/builder/mask/mask_sectors.h"
#include "octree/builder/sort/chunks.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// What a test can replace in a build: sizes, so that small models run the code for large ones, and
/// the system, so that any call can fail.
struct BuildSeams {
  std::uint64_t chunk_triangles = kChunkTriangles;    ///< the tree depends on it
  std::uint64_t sector_triangles = kSectorTriangles;  ///< the mask depends on it
  std::optional<BuildMemory> memory;  ///< in place of share(); nothing depends on it
  storage::FileCalls& calls = storage::FileCalls::real();
};

}  // namespace planetree::octree
