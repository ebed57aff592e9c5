#pragma once

#include <cstdint>
#include <optional>

#include "octree/builder/job/build_memory.h"
#include "octree/builder/mask/mask_sectors.h"
#include "octree/builder/sort/chunks.h"
#include "storage/system/file_calls.h"

namespace planetree::octree {

/// Where a build can be taken apart: sizes, so that small models go the ways of large ones,
/// and the system, so that any call can fail.
struct BuildSeams {
  std::uint64_t chunk_triangles = kChunkTriangles;    ///< the tree depends on it
  std::uint64_t sector_triangles = kSectorTriangles;  ///< the mask depends on it
  std::optional<BuildMemory> memory;                  ///< as shared out; nothing depends on it
  storage::FileCalls& calls = storage::FileCalls::real();
};

}  // namespace planetree::octree
