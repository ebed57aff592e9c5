#pragma once

#include <cstdint>

#include "planetree/error.h"

namespace planetree::octree {

/// How a build divides the memory it may use. The bytes of the output do not depend on it.
struct BuildMemory {
  /// Memory of the program itself, and of each thread: a chunk of 2^18 triangles, its trees and
  /// pages.
  static constexpr std::uint64_t kFixedBytes = std::uint64_t{64} << 20;
  static constexpr std::uint64_t kThreadBytes = std::uint64_t{96} << 20;
  static constexpr std::uint64_t kMinBytes = kFixedBytes + kThreadBytes;

  int threads = 1;                    ///< threads that fit in the memory
  std::uint32_t batch_triangles = 0;  ///< triangles that a thread sorts at a time
  std::uint64_t reading_bytes = 0;    ///< the input: vertices and a window of the file
  std::uint64_t spool_bytes = 0;      ///< triangles as they are read
  std::uint64_t runs_bytes = 0;       ///< sorted triangles
  std::uint64_t pages_bytes = 0;      ///< pages, until they are written
  std::uint64_t edge_bytes = 0;       ///< edges that chunks share
  std::uint64_t cap_bytes = 0;        ///< edges that caps close, then caps
  std::uint64_t visitor_bytes = 0;    ///< triangles that touch other sectors than their own
  std::uint64_t part_bytes = 0;       ///< sorted triangles that touch the region

  /// Divides memory among the steps of a build.
  ///
  /// bytes    maximum for the process; 0: a quarter of the machine's memory, at least kMinBytes.
  /// threads  maximum; 0: as many as the machine has.
  /// errors   kNoMemory: too little for one thread; the text says how much is needed.
  static Result<BuildMemory> share(std::uint64_t bytes, unsigned threads);

  /// The shares of a build with a checkpoint: sorted triangles and pages always go to disk.
  BuildMemory with_checkpoint() const;
};

}  // namespace planetree::octree
