#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "planetree/error.h"
#include "storage/file_layout.h"

/// From a mesh file to a .ptree file.
namespace planetree::octree {

/// What a build is doing.
enum class BuildPhase : std::uint8_t {
  kReading,
  kClosing,
  kOrdering,
  kBounding,
  kColouring,
  kWriting
};

/// Told how far a build is, on the thread that called build_tree.
class BuildProgress {
 public:
  virtual ~BuildProgress() = default;
  /// `done` of `total` units of this phase: bytes while reading, pages while
  /// writing, steps otherwise.
  virtual void progress(BuildPhase phase, std::uint64_t done, std::uint64_t total) = 0;
};

struct BuildOptions {
  std::uint32_t page_bytes = 65536;  ///< of a decoded page; a power of two, 4 KiB to 256 KiB
  unsigned threads = 0;              ///< 0: as many as the machine has
  bool strict = false;               ///< a set-aside record is an error
  bool replace = false;              ///< an existing output may be replaced
};

struct BuildReport {
  storage::FileHeader header;   ///< as written
  std::string first_set_aside;  ///< the first bad record in words; empty if none
};

/// Reads the mesh at `input` and writes its tree to `output`, whole or not at
/// all. The bytes written depend on the mesh and page_bytes alone.
///
/// memory  holds the model: about 70 bytes a triangle, 110 with float64
///         coordinates; 3 more of a model that is not watertight.
/// errors  those of read_mesh and storage::PageWriter; kBadArgument for
///         page_bytes; kBadInput for a bad record under `strict`.
/// source  bottom-up construction from candidate planes: "Out-of-core real-time
///         haptic interaction on very large models", section 3.1; blocks,
///         collapse and paging are ours.
Result<BuildReport> build_tree(const std::filesystem::path& input,
                               const std::filesystem::path& output, const BuildOptions& options,
                               BuildProgress& progress);

}  // namespace planetree::octree
