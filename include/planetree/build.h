#pragma once

#include <array>
#include <atomic>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "planetree/error.h"
#include "planetree/export.h"
#include "planetree/types.h"

/// @file
/// Building a .ptree file: from a mesh file, from a mesh in memory, or from a callback that streams
/// triangles. None of them needs to fit in memory together with the tree.

namespace planetree {

/// The corners of a triangle, in model units. They run counterclockwise seen from outside of the
/// solid.
using TriangleCorners = std::array<Vec3, 3>;
/// A vertex as three floats, in model units.
using FloatVertex = std::array<float, 3>;
/// The indices of a triangle's vertices, from 0.
using TriangleVertices = std::array<std::uint32_t, 3>;

/// Gives the triangles of a build, some at a time: writes the next ones to the front of a buffer,
/// which is never empty, and returns their number. 0 ends the triangles. An error ends the build
/// and is returned from it. Calls come from the thread that called build(), one after the other.
using TriangleSource = std::function<Result<std::size_t>(std::span<TriangleCorners>)>;

/// What a file is built from. A triangle's index, which answers name, counts the triangles in the
/// order of the input, skipped ones included.
///
/// Of equal triangles in equal order the same file is built, however they are given. Only
/// ModelInfo::vertices may differ: a mesh file and a mesh in memory have the vertices that they
/// list, a callback has three for each triangle, as an STL has. Coordinates that floats hold are
/// stored as floats, also where they are given as doubles.
class BuildInput {
 public:
  /// A mesh in memory. A triangle that names a missing vertex, or one that is not finite, is
  /// skipped.
  template <class Vertex>
  struct Mesh {
    std::span<const Vertex> vertices;             ///< positions in model units
    std::span<const TriangleVertices> triangles;  ///< indices into `vertices`
  };
  /// Triangles from a callback. A triangle with a corner that is not finite is skipped.
  struct Stream {
    TriangleSource source;  ///< gives the triangles
    /// Number of triangles that are expected, or 0. Only progress and the check of free space
    /// depend on it.
    std::uint64_t expected_triangles = 0;
  };
  /// One of the ways to give triangles.
  using Content = std::variant<std::filesystem::path, Mesh<Vec3>, Mesh<FloatVertex>, Stream>;

  /// A mesh file: PLY, STL or OFF (text or binary) or OBJ; docs/formats.md says what of them. The
  /// content decides the format, but an OBJ needs its extension. A regular file; it must not change
  /// during the build.
  template <class Path>
  requires std::convertible_to<const Path&, std::filesystem::path> &&
      (!std::same_as<Path, BuildInput>)BuildInput(const Path& path)
      : content_(std::filesystem::path(path)) {}
  /// A mesh in memory. The arrays are not copied: they must stay as they are until build() returns.
  BuildInput(std::span<const Vec3> vertices, std::span<const TriangleVertices> triangles)
      : content_(Mesh<Vec3>{vertices, triangles}) {}
  /// As above, with float coordinates.
  BuildInput(std::span<const FloatVertex> vertices, std::span<const TriangleVertices> triangles)
      : content_(Mesh<FloatVertex>{vertices, triangles}) {}
  /// Triangles from a callback.
  explicit BuildInput(TriangleSource source, std::uint64_t expected_triangles = 0)
      : content_(Stream{std::move(source), expected_triangles}) {}

  /// What was given.
  const Content& content() const noexcept { return content_; }

 private:
  Content content_;
};

/// Phases of a build, in order.
enum class BuildPhase : std::uint8_t {
  kResuming,      ///< checking the work of an earlier build
  kReading,       ///< reading the input, in bytes
  kOrdering,      ///< sorting triangles along a Morton curve, in batches
  kMatching,      ///< matching edges, to find whether the surface is watertight; in chunks
  kListing,       ///< collecting the faces at unbalanced edges, in chunks
  kBuildingTree,  ///< building the tree, in chunks
  kBuildingMask,  ///< finding the cells inside and outside, in sectors of space
  kWriting        ///< writing the file, in pages
};

/// Name of a phase for messages, such as "matching edges".
constexpr const char* name_of(BuildPhase phase) noexcept {
  switch (phase) {
    case BuildPhase::kResuming:
      return "resuming";
    case BuildPhase::kReading:
      return "reading";
    case BuildPhase::kOrdering:
      return "ordering";
    case BuildPhase::kMatching:
      return "matching edges";
    case BuildPhase::kListing:
      return "listing unbalanced edges";
    case BuildPhase::kBuildingTree:
      return "building tree";
    case BuildPhase::kBuildingMask:
      return "building mask";
    case BuildPhase::kWriting:
      break;
  }
  return "writing";
}

/// A box with its sides along the axes, in model units.
struct Box {
  Vec3 lower,  ///< least corner
      upper;   ///< greatest corner
};

/// Options of build(). The file depends on `page_bytes`, `box` and `float64` alone.
struct BuildOptions {
  /// Maximum memory of the build in bytes, at least kMinMemoryBytes: resident memory of the process
  /// where that holds less than 64 MiB otherwise. 0 means a quarter of the machine's. What does not
  /// fit is spilled to temporary files. Arrays of a BuildInput do not count.
  std::uint64_t memory_bytes = 0;
  /// Maximum number of threads, the caller's included; 0 means one for each processor. Each takes
  /// 96 MiB of `memory_bytes`; fewer are used where that is too little.
  unsigned threads = 0;
  /// Directory for temporary files, about 120 bytes a triangle where memory is short, 200 with
  /// double coordinates. They have no names and vanish with the process, except for what `resume`
  /// keeps. Empty means the directory of the output.
  std::filesystem::path temp_directory;
  /// Size of a decoded page in bytes: a power of two from kMinPageBytes to kMaxPageBytes.
  std::uint32_t page_bytes = 65536;
  /// Builds only the triangles that touch this box; see ModelInfo::has_region.
  std::optional<Box> box;
  /// Keeps completed work in the directory `OUTPUT.work`, beside the output or in
  /// `temp_directory`, until the file is complete. A later build of the same input and options
  /// resumes there. Not for triangles from a callback.
  bool resume = false;
  /// Reads coordinates that an ascii PLY declares as floats as doubles, with all their digits.
  /// Other text formats declare no type, and are read as doubles anyway.
  bool float64 = false;
  bool strict = false;   ///< a record that cannot be used is an error instead of being skipped
  bool replace = false;  ///< an existing output may be replaced

  /// Called with the progress of the build: `done` of `total` units of a phase. `done` never
  /// decreases within a phase; `total` may grow. Return false to cancel the build. Calls come from
  /// any thread, one at a time, about every 4 MiB of the input and then a few a second.
  std::function<bool(BuildPhase phase, std::uint64_t done, std::uint64_t total)> on_progress;
  /// Set to true, by any thread, to cancel the build. It is read as often as there is progress.
  const std::atomic<bool>* cancel = nullptr;
  /// Called once if `resume` is set, with one line that says what work is resumed, or why none is.
  std::function<void(const std::string& line)> on_resume;
  /// Called once before an error is returned, with the file or directory that it concerns. The path
  /// is empty where that is an input in memory.
  std::function<void(const std::filesystem::path& path)> on_failure;

  /// Minimum of `memory_bytes`, for one thread.
  static constexpr std::uint64_t kMinMemoryBytes = std::uint64_t{160} << 20;
  static constexpr std::uint32_t kMinPageBytes = 4096;    ///< minimum of `page_bytes`
  static constexpr std::uint32_t kMaxPageBytes = 262144;  ///< maximum of `page_bytes`
};

/// What was built.
struct BuildReport {
  std::uint64_t triangles = 0;                ///< triangles in the file
  std::uint64_t input_triangles = 0;          ///< usable triangles of the input, in the box or not
  std::uint64_t skipped = 0;                  ///< triangle indices that skipped records take
  std::uint64_t first_skipped = kNoTriangle;  ///< the least of those indices, or kNoTriangle
  std::string first_skipped_text;  ///< what is wrong with that record; empty if there is none
  /// What the reader of a file passed over or took in another way than it is written: a line for
  /// each kind, with its count and where it is first.
  std::vector<std::string> notes;
  std::uint64_t vertices = 0;          ///< vertex records of the input
  std::uint64_t unbalanced_edges = 0;  ///< edges that more faces run along one way than the other
  std::uint64_t nodes = 0;             ///< inner nodes of the tree
  std::uint64_t blocks = 0;            ///< leaves of the tree: blocks of up to 16 triangles
  std::uint32_t levels = 0;            ///< maximum number of nodes on a path from root to block
  std::uint32_t pages = 0;             ///< distance and mask pages
  std::uint64_t file_bytes = 0;        ///< length of the file
  std::uint64_t temporary_bytes = 0;   ///< bytes that were spilled to temporary files
  std::uint64_t peak_resident_bytes = 0;  ///< peak resident memory of the process so far
  std::uint64_t content_id[2] = {};       ///< hash over all page hashes: equal for equal trees

  /// Whether as many faces run along every edge one way as the other.
  bool watertight() const noexcept { return unbalanced_edges == 0; }
};

/// Builds the .ptree file of a mesh. The file appears whole or not at all: after an error or a
/// cancelled build nothing is left, except for what BuildOptions::resume keeps. The bytes of the
/// file depend on the input, `page_bytes`, `box` and `float64` alone.
///
/// input    triangles in any order. Records that cannot be used are skipped and counted.
/// output   the file. Its directory must exist.
/// errors   kBadArgument: an option is out of range, no triangle touches the box, or `output` is
///          a directory or the input. kAlreadyExists: the file exists and may not be replaced.
///          kNotFound, kPermission: a file or directory is missing or closed to the caller.
///          kBadInput: the mesh is damaged, has no usable triangle, or has a bad record and
///          `strict` is set; or a callback of the caller threw. kNoMemory, kNoSpace: too little of
///          `memory_bytes`, of memory, or of space on the device; the space is checked before the
///          work begins. kReadFailed, kWriteFailed, kDamaged: the system failed. kUnsupported:
///          compiler options or the processor change floating-point results. kCancelled. Where a
///          text names an option of the command, such as --memory, BuildOptions has it too.
/// threads  any; several builds may run at once. Uses oneTBB on BuildOptions::threads threads,
///          allocates, and waits for the disk. Floating-point modes of the calling thread do not
///          matter.
[[nodiscard]] PLANETREE_API Result<BuildReport> build(const BuildInput& input,
                                                      const std::filesystem::path& output,
                                                      const BuildOptions& options = {});

}  // namespace planetree
