#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "octree/builder/mesh/stream/triangle_sink.h"
#include "planetree/error.h"

namespace planetree::octree {

/// Passes the triangles of several mesh files on as those of one mesh. Texts about records begin
/// with the path of their file. Progress is counted in bytes of the files as they are on disk.
///
/// threads  one at a time.
class MeshSequence final : public TriangleSink {
 public:
  /// file_bytes  lengths of the files, in order.
  /// next        receives the triangles; must outlive this.
  MeshSequence(std::vector<std::uint64_t> file_bytes, TriangleSink& next);

  /// Begins the next file. What is received until end_file() is of it.
  void begin_file(const std::filesystem::path& path);
  /// Ends the file.
  ///
  /// summary  of the file.
  /// keep     as MeshOptions::keep.
  /// errors   kBadInput: values are kept, and are of another type than those of the files before.
  Result<void> end_file(const MeshSummary& summary, std::uint32_t keep);
  /// The summary of all files that have ended.
  [[nodiscard]] const MeshSummary& summary() const { return joined_; }

  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override;
  Result<void> attributes(const TriangleAttributes& attributes) override;
  void skipped(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) override;
  Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override;

 private:
  void add_polygons(const OddPolygons& polygons);
  [[nodiscard]] std::string named(const std::string& text) const { return path_ + ": " + text; }

  const std::vector<std::uint64_t> file_bytes_;
  TriangleSink& next_;
  std::string path_;
  MeshSummary joined_;
  std::uint64_t bytes_before_ = 0;  // of the files that have ended
  std::uint64_t bytes_done_ = 0;
  std::uint64_t bytes_total_ = 0;
};

}  // namespace planetree::octree
