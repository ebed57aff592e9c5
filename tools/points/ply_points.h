#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_lines.h"
#include "octree/builder/mesh/stream/mesh_window.h"
#include "tools/points/row_reader.h"

namespace planetree::tools {

/// The vertices of a PLY file, with or without faces.
class PlyPoints final : public PointReader {
 public:
  /// errors  kBadInput: the header is damaged, or the position of the vertices does not follow from
  ///         it. Those of reading the file.
  static Result<std::unique_ptr<PointReader>> create(const std::string& path,
                                                     octree::MeshFile file);

  Result<std::size_t> read(std::span<Vec3> points) override;

 private:
  PlyPoints(std::string name, octree::MeshFile file, octree::PlyHeader header);
  Result<void> find_vertices();
  Result<void> check_length() const;
  Result<void> read_record(Vec3& point);
  Result<void> read_line(Vec3& point);
  Error refusal(const char* cause) const;

  octree::MeshFile file_;
  octree::PlyHeader header_;
  octree::MeshLines lines_;         // ascii
  octree::MeshWindow window_;       // binary
  std::uint64_t offset_ = 0;        // binary
  std::uint64_t record_bytes_ = 0;  // binary
  std::array<std::uint64_t, 3> coordinate_offsets_ =
      {};                            // offsets of x, y and z in a binary record
  std::uint64_t vertices_left_ = 0;  // vertices not yet read
  std::optional<Error> failure_;     // reported after the points before it
};

}  // namespace planetree::tools
