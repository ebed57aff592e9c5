#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "octree/builder/job/region_box.h"

namespace planetree::octree {

struct BuildOptions {
  std::uint32_t page_bytes = 65536;  ///< of a decoded page; a power of two, 4 KiB to 256 KiB
  unsigned threads = 0;              ///< 0: as many as the machine has
  /// The most that the process should have resident; 0: a quarter of the machine's
  /// memory. What does not fit is spilled.
  std::uint64_t memory_bytes = 0;
  std::filesystem::path temp_directory;  ///< for what is spilled; empty: the output's
  bool strict = false;                   ///< a set-aside record is an error
  bool replace = false;                  ///< an existing output may be replaced
  /// Only triangles that touch it are built. Sides are those of the whole input.
  std::optional<RegionBox> box;
  /// What is completed is kept, and what an earlier build of the same completed is gone on with.
  bool resume = false;

  /// Where the output will be.
  static std::filesystem::path output_directory(const std::filesystem::path& output);
  /// Where a build of this output spills.
  std::filesystem::path spill_directory(const std::filesystem::path& output) const;
  /// Where one that can be resumed keeps its work: a directory of its own.
  std::filesystem::path work_directory(const std::filesystem::path& output) const;
};

}  // namespace planetree::octree
