#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "octree/builder/job/region_box.h"
#include "planetree/attributes.h"
#include "planetree/error.h"
#include "planetree/layers.h"
#include "planetree/metadata.h"
#include "storage/file/file_layout.h"

namespace planetree::octree {

struct BuildOptions {
  static constexpr std::uint64_t kMinMemberBytes = 65536;

  std::uint32_t page_bytes = 65536;  ///< size of a decoded page: a power of two, 4 KiB to 256 KiB
  unsigned threads = 0;              ///< 0: as many as the machine has
  /// Maximum resident memory of the process; 0: a quarter of the machine's memory. What does not
  /// fit is spilled.
  std::uint64_t memory_bytes = 0;
  std::filesystem::path temp_directory;  ///< for spilled data; empty: that of the output
  bool float64 = false;                  ///< floats of a text are read as doubles
  bool strict = false;                   ///< a skipped record is an error
  bool replace = false;                  ///< an existing output may be replaced
  /// How queries decide sides; empty: as the openness of the surface suggests.
  std::optional<storage::SideRule> side;
  /// Attributes of triangles to keep: kKeepTriangles and others, combined with `|`.
  std::uint32_t keep = 0;
  std::string value_property = "value";  ///< see MeshOptions::value_property
  std::uint32_t layers = kAllLayers;     ///< layers of the file; that of distances is always built
  /// Builds only the triangles that touch this box. Points are inside or outside of the whole
  /// input.
  std::optional<RegionBox> box;
  /// Keeps completed work in a checkpoint, and resumes the one that an earlier build of the same
  /// input and options left.
  bool resume = false;
  std::uint64_t member_bytes = 0;  ///< 0: one file; else a set, see planetree::BuildOptions
  Metadata metadata;               ///< as in the file; without a generator there is none

  bool has_side_layer() const { return (layers & kSideLayer) != 0; }
  /// What the file keeps: `keep`, with the links that all attributes need.
  std::uint32_t kept_attributes() const { return keep == 0 ? 0 : keep | kKeepTriangles; }
  bool has_field_layer() const { return (layers & kFieldLayer) != 0; }
  /// errors  kBadArgument: page_bytes is none of a page; an unknown layer or attribute; members are
  ///         too short; the box is none, see RegionBox::check()
  Result<void> check() const;
  /// Directory of the output.
  static std::filesystem::path output_directory(const std::filesystem::path& output);
  /// Directory in which a build of this output spills.
  std::filesystem::path spill_directory(const std::filesystem::path& output) const;
  /// Directory that holds the checkpoint of a build of this output, and nothing else.
  std::filesystem::path work_directory(const std::filesystem::path& output) const;
};

}  // namespace planetree::octree
