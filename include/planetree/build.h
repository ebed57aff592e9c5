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

#include "planetree/attributes.h"
#include "planetree/error.h"
#include "planetree/export.h"
#include "planetree/layers.h"
#include "planetree/metadata.h"
#include "planetree/types.h"

/// @file
/// Building a .ptree file: from mesh files, from a mesh in memory, or from a callback that streams
/// triangles. The mesh and the tree together may be larger than memory.

namespace planetree {

/// The corners of a triangle, in model units, counterclockwise as seen from outside of the solid.
using TriangleCorners = std::array<Vec3, 3>;
/// A vertex as three floats, in model units.
using FloatVertex = std::array<float, 3>;
/// The indices of a triangle's vertices, from 0.
using TriangleVertices = std::array<std::uint32_t, 3>;

/// A callback that supplies the triangles of a build. Each call writes the next triangles to the
/// start of the span, whose size is at least 1, and returns their number. 0 means that there are no
/// more. A number above the size of the span is an error. If the callback returns an error, build()
/// stops and returns it. If it throws, build() returns ErrorCode::kBadInput. Calls come from the
/// thread that called build(), one after the other.
using TriangleSource = std::function<Result<std::size_t>(std::span<TriangleCorners>)>;

/// What a file is built from. Answers identify a triangle by its index: its position in the input,
/// from 0. Skipped triangles count too.
///
/// Equal triangles in equal order give equal files, with one exception: ModelInfo::vertices is the
/// number of vertices that mesh files or a mesh in memory list, and three per triangle for a
/// callback or an STL file. If every coordinate is exactly a float, the file stores floats, even if
/// the input has doubles.
class BuildInput {
 public:
  /// A mesh in memory. A triangle is skipped if one of its indices is out of range or a coordinate
  /// of its corners is not finite. A mesh has at most 2^32 vertices that triangles can use.
  template <class Vertex>
  struct Mesh {
    std::span<const Vertex> vertices;             ///< positions in model units
    std::span<const TriangleVertices> triangles;  ///< indices into `vertices`
    std::span<const Color> colors = {};           ///< for kKeepColor: one for each vertex
    /// For kKeepUv: one for each vertex, or three for each triangle, in the order of its corners.
    std::span<const TextureCoordinate> uvs = {};
    std::span<const std::uint64_t> values = {};   ///< for kKeepValue: the bits, for each triangle
    ValueKind value_kind = ValueKind::kUnsigned;  ///< type of the values
  };
  /// Triangles from a callback. A triangle is skipped if a coordinate of its corners is not finite.
  struct Stream {
    TriangleSource source;  ///< supplies the triangles
    /// Expected number of triangles, or 0 if unknown. Only progress and the check of free space
    /// depend on it.
    std::uint64_t expected_triangles = 0;
  };
  /// Mesh files, two or more, that together are one mesh.
  struct Files {
    std::vector<std::filesystem::path> paths;  ///< in the order of the triangles
  };
  /// One of the kinds of input.
  using Content = std::variant<std::filesystem::path, Mesh<Vec3>, Mesh<FloatVertex>, Stream, Files>;

  /// A mesh file: PLY, STL or OFF (text or binary), glTF 2.0 (JSON or binary) or OBJ, as it is or
  /// compressed by gzip or zstd. docs/formats.md lists what is read of each. The format is detected
  /// from the content, except for OBJ, which needs the extension .obj (.obj.gz or .obj.zst if
  /// compressed). The file, and those that hold the buffers of a glTF, must be regular files and
  /// must not change during the build.
  template <class Path>
  requires std::convertible_to<const Path&, std::filesystem::path> &&
      (!std::same_as<Path, BuildInput>)BuildInput(const Path& path)
      : content_(std::filesystem::path(path)) {}
  /// Mesh files that together are one mesh, under the same rules; their formats may differ. The
  /// triangles, and so their indices, follow each other in the order of the files. Each file must
  /// have a usable triangle, and all attributes that BuildOptions::keep names, of the same type. An
  /// empty list is an error of the build; a list of one is that file.
  explicit BuildInput(std::vector<std::filesystem::path> paths) {
    if (paths.size() == 1)
      content_ = std::move(paths.front());
    else
      content_ = Files{std::move(paths)};
  }
  /// A mesh in memory. The arrays are not copied. They must stay unchanged until build() returns.
  BuildInput(std::span<const Vec3> vertices, std::span<const TriangleVertices> triangles)
      : content_(Mesh<Vec3>{vertices, triangles}) {}
  /// A mesh in memory with float coordinates, under the same rules.
  BuildInput(std::span<const FloatVertex> vertices, std::span<const TriangleVertices> triangles)
      : content_(Mesh<FloatVertex>{vertices, triangles}) {}
  /// A mesh in memory with attributes, under the same rules.
  BuildInput(const Mesh<Vec3>& mesh) : content_(mesh) {}
  /// A mesh in memory with float coordinates and attributes, under the same rules.
  BuildInput(const Mesh<FloatVertex>& mesh) : content_(mesh) {}
  /// Triangles from a callback.
  explicit BuildInput(TriangleSource source, std::uint64_t expected_triangles = 0)
      : content_(Stream{std::move(source), expected_triangles}) {}

  /// Returns the input.
  const Content& content() const noexcept { return content_; }

 private:
  Content content_;
};

/// Phases of a build, in order. Each comment names the unit of progress.
enum class BuildPhase : std::uint8_t {
  kResuming,       ///< checking the checkpoint of an earlier build; one unit
  kReading,        ///< reading the input; bytes
  kOrdering,       ///< sorting triangles in Morton order; parts of the triangle spool
  kMatching,       ///< matching edges, to find unbalanced ones; chunks of triangles
  kListing,        ///< collecting the faces at unbalanced edges; chunks of triangles
  kBuildingTree,   ///< building the tree; chunks of triangles
  kBuildingMask,   ///< building the mask; sectors of the octree
  kBuildingField,  ///< building the coarse field; tiles of its grid
  kWriting         ///< writing the file; pages
};

/// Returns the name of a phase for messages, such as "matching edges".
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
    case BuildPhase::kBuildingField:
      return "building field";
    case BuildPhase::kWriting:
      break;
  }
  return "writing";
}

/// How a build decides which SideRule queries use by default.
enum class SideChoice : std::uint8_t {
  kAuto,    ///< by BuildReport::openness; a watertight surface is a solid
  kSolid,   ///< SideRule::kSolid
  kSurface  ///< SideRule::kSurface
};

/// Options of build(). Of these, only `page_bytes`, `box`, `side`, `layers`, `keep`,
/// `value_property`, `float64` and `metadata` change the bytes of the file.
struct BuildOptions {
  /// Maximum memory of the build in bytes, at least kMinMemoryBytes. It limits the resident memory
  /// of the whole process if the rest of the program takes less than 64 MiB. Arrays of a BuildInput
  /// do not count. 0 means a quarter of the machine's memory, but at least kMinMemoryBytes. The
  /// build spills what does not fit to temporary files.
  std::uint64_t memory_bytes = 0;
  /// Maximum number of threads, the caller's included. 0 means one for each processor. Each thread
  /// takes 96 MiB of `memory_bytes`, beside 64 MiB for the build as a whole. If `memory_bytes` is
  /// too small for so many threads, the build uses fewer.
  unsigned threads = 0;
  /// Directory for temporary files. It must exist. Empty means the directory of the output. If the
  /// data does not fit in memory, temporary files take about 120 bytes per triangle, or 200 with
  /// double coordinates. The content of a compressed mesh always takes its length. Temporary files
  /// have no names, so the system removes them when the process ends. The checkpoint of `resume` is
  /// the exception.
  std::filesystem::path temp_directory;
  /// Size of a decoded page in bytes: a power of two from kMinPageBytes to kMaxPageBytes.
  std::uint32_t page_bytes = 65536;
  /// Builds only the triangles that touch this box, the region; see ModelInfo::has_region. Its
  /// corners must be finite, and `lower` at most `upper` on each axis.
  std::optional<Box> box;
  /// How queries decide sides by default; see SideRule.
  SideChoice side = SideChoice::kAuto;
  /// Layers of the file: kSideLayer and kFieldLayer, combined with `|`. The distance layer is
  /// always built, and the attribute layer if `keep` is not 0. What is left out is not built, takes
  /// no room in the file, and cannot be opened; see OpenOptions::layers. Without kSideLayer the
  /// build makes neither mask nor caps. It matches edges in any case, so that the file states
  /// whether the surface is watertight.
  std::uint32_t layers = kAllLayers;
  /// Attributes that the file keeps, combined with `|`: kKeepTriangles, kKeepColor, kKeepUv and
  /// kKeepValue. A mesh without one of them is an error. docs/formats.md says where each format has
  /// them.
  std::uint32_t keep = 0;
  /// The property of a PLY's faces whose values kKeepValue keeps.
  std::string value_property = "value";
  /// Keeps a checkpoint: completed work in a directory that is removed when the file is complete. A
  /// later build of the same input and options resumes it. The directory is `OUTPUT.work` beside
  /// the output. If `temp_directory` is set, it is there, and its name also has a hash of the
  /// output's path. For a callback as input, kBadArgument is returned.
  bool resume = false;
  /// Reads coordinates that an ascii PLY declares as floats as doubles, with all their digits.
  /// Other text formats declare no type; their coordinates are always read as doubles.
  bool float64 = false;
  /// What the file says of the model; see Metadata. `generator` is set to the release of planetree
  /// unless it is given. A key with an empty value is left out.
  Metadata metadata;
  bool strict = false;   ///< a record that would be skipped is an error
  bool replace = false;  ///< an existing output may be replaced

  /// Called with the progress of the build: `done` of `total` units of a phase, see BuildPhase.
  /// `done` never decreases within a phase. `total` may grow. Return false to cancel the build.
  /// Calls come from any thread, but never two at the same time. While the build reads, calls come
  /// about every 4 MiB of the input, and in later phases about once per unit.
  std::function<bool(BuildPhase phase, std::uint64_t done, std::uint64_t total)> on_progress;
  /// Set it to true, from any thread, to cancel the build. The build reads it whenever it reports
  /// progress. May be null; else it must stay valid until build() returns.
  const std::atomic<bool>* cancel = nullptr;
  /// Called once if `resume` is set, with one line that says what work is resumed, or why none is.
  /// The call comes from the thread that called build().
  std::function<void(const std::string& line)> on_resume;
  /// Called once before an error is returned, with the file or directory that the error concerns.
  /// The path is empty if that is an input in memory, a callback or several files as a whole. The
  /// call comes from the thread that called build().
  std::function<void(const std::filesystem::path& path)> on_failure;

  /// Minimum of `memory_bytes`; it suffices for one thread.
  static constexpr std::uint64_t kMinMemoryBytes = std::uint64_t{160} << 20;
  static constexpr std::uint32_t kMinPageBytes = 4096;    ///< minimum of `page_bytes`
  static constexpr std::uint32_t kMaxPageBytes = 262144;  ///< maximum of `page_bytes`
};

/// What was built.
struct BuildReport {
  std::uint64_t triangles = 0;                ///< triangles in the file
  std::uint64_t input_triangles = 0;          ///< usable triangles of the whole input
  std::uint64_t skipped = 0;                  ///< number of triangle indices of skipped records
  std::uint64_t first_skipped = kNoTriangle;  ///< the lowest of these indices, or kNoTriangle
  std::string first_skipped_text;  ///< what is wrong with that record; empty if there is none
  /// What the reader of a file ignored or changed: a line for each kind, with its count and the
  /// place of the first. If the input is several files, each of these lines, and each text about a
  /// record here, begins with the path of the file.
  std::vector<std::string> notes;
  /// Number of polygons that are not convex and whose corners are not in one plane. They are split
  /// as seen along an axis.
  std::uint64_t nonplanar_polygons = 0;
  std::string first_nonplanar_text;  ///< names the first of them; empty if there is none
  /// Number of polygons that cross themselves, have more than 2^20 corners, or would take long to
  /// split. They are split into fans, which may reach beyond them.
  std::uint64_t fanned_polygons = 0;
  std::string first_fanned_text;       ///< names the first of them; empty if there is none
  std::uint64_t vertices = 0;          ///< vertex records of the input
  std::uint64_t strays = 0;            ///< triangles of the input far outside of all others
  std::uint64_t unbalanced_edges = 0;  ///< edges that are not balanced, see watertight()
  /// How sides are decided by default: SideRule::kSolid or kSurface. An open surface of an openness
  /// of 0.375 or more is taken for a sheet, unless BuildOptions::side says otherwise.
  SideRule side_rule = SideRule::kSolid;
  bool side_is_chosen = false;  ///< whether BuildOptions::side chose the rule
  /// How open the surface of the input is: the length of the sum of the triangles' area vectors,
  /// divided by the sum of their areas, without strays. 0 if closed, 1 for a flat sheet.
  double openness = 0;
  std::uint64_t nodes = 0;                ///< inner nodes of the tree
  std::uint64_t blocks = 0;               ///< leaves of the tree: blocks of up to 16 triangles
  std::uint32_t levels = 0;               ///< height of the tree, in nodes
  std::uint32_t layers = kAllLayers;      ///< layers of the file; no field if it is too coarse
  std::uint32_t attributes = 0;           ///< attributes that the file keeps; 0: none
  std::uint32_t pages = 0;                ///< pages of all layers
  std::uint64_t file_bytes = 0;           ///< length of the file
  std::uint64_t temporary_bytes = 0;      ///< bytes that were spilled to temporary files
  std::uint64_t peak_resident_bytes = 0;  ///< peak resident memory since the process started
  std::uint32_t page_bytes = 0;           ///< size of a decoded page
  Metadata metadata;                      ///< what the file says of the model
  std::uint64_t content_id[2] = {};       ///< hash over the hashes of all pages, low word first

  /// Whether every edge of the input is balanced: as many triangles traverse it in one direction as
  /// in the other.
  bool watertight() const noexcept { return unbalanced_edges == 0; }
};

/// Builds the .ptree file of a mesh. The file appears under its name when it is complete. After an
/// error or a cancelled build an earlier file of that name is unchanged, and no new file is left,
/// except for the checkpoint of BuildOptions::resume. The bytes of the file depend on the input,
/// `page_bytes`, `box`, `side`, `layers`, `keep`, `value_property`, `float64`, `metadata`, and the
/// releases of planetree and LZ4, and on nothing else.
///
/// input    triangles in any order. Records that cannot be used are skipped and counted.
/// output   the file. Its directory must exist.
/// errors   kBadArgument: an option is out of range, no triangle touches the box, or `output` is
///          a directory or the input. kAlreadyExists: the file exists and `replace` is not set.
///          kNotFound: a file or directory does not exist. kPermission: it is not accessible.
///          kBadInput: the mesh is malformed, has no usable triangle, or has a bad record and
///          `strict` is set; or a callback threw. kNoMemory: `memory_bytes` is too small, or the
///          system refuses memory or threads. kNoSpace: the device has too little free space; the
///          build checks this before it starts. kReadFailed, kWriteFailed: the system or a device
///          failed. kTruncated, kDamaged: a temporary file does not have what was written to it.
///          kUnsupported: compiler options or the processor change floating-point results.
///          kCancelled. A text may name an option of the command, such as --memory: BuildOptions
///          has the same option.
/// threads  any; several builds may run at once. Uses oneTBB on BuildOptions::threads threads,
///          allocates, and waits for the disk. Callers need not set a floating-point mode.
[[nodiscard]] PLANETREE_API Result<BuildReport> build(const BuildInput& input,
                                                      const std::filesystem::path& output,
                                                      const BuildOptions& options = {});

}  // namespace planetree
