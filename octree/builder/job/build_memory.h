#pragma once

#include <cstdint>

#include "planetree/error.h"

namespace planetree::octree {

/// How a build shares out the memory it may use. Nothing that is written depends on it.
struct BuildMemory {
  /// The program itself; and for each thread a patch of 2^18 triangles, its trees and pages.
  static constexpr std::uint64_t kFixedBytes = std::uint64_t{64} << 20;
  static constexpr std::uint64_t kThreadBytes = std::uint64_t{96} << 20;
  static constexpr std::uint64_t kMinBytes = kFixedBytes + kThreadBytes;

  int threads = 1;                    ///< that it has room for
  std::uint32_t batch_triangles = 0;  ///< sorted at a time, by each thread
  std::uint64_t reading_bytes = 0;    ///< of the input: vertices and a window of the file
  std::uint64_t spool_bytes = 0;      ///< of triangles as they are read
  std::uint64_t runs_bytes = 0;       ///< of sorted triangles
  std::uint64_t pages_bytes = 0;      ///< of pages, until they are written
  std::uint64_t edge_bytes = 0;       ///< of edges that patches have in common
  std::uint64_t visitor_bytes = 0;    ///< of triangles that regions have in common
  std::uint64_t part_bytes = 0;       ///< of sorted triangles that touch the part to be built

  /// bytes    the most that the process should have; 0: a quarter of the machine's.
  /// threads  0: as many as the machine has.
  /// errors   kNoMemory: too little for one thread; says how much is needed.
  static Result<BuildMemory> share(std::uint64_t bytes, unsigned threads);

  /// The same where triangles in order and pages go to disk in any case.
  BuildMemory holding_nothing_kept() const;
};

}  // namespace planetree::octree
