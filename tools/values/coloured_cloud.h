#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "planetree/error.h"
#include "planetree/types.h"
#include "tools/cli/output_file.h"
#include "tools/values/colour_scale.h"
#include "tools/values/record_spool.h"

namespace planetree::tools {

/// A file of points with a value and its colour, and of triangles between them: a binary PLY, or,
/// if the file is named so, a VTK file (.vtp) or a NumPy array (.npy), which has the points alone.
///
/// Points and triangles wait in temporary files without names, since the colours and the counts are
/// known only at the end. So memory does not grow with their number.
class ColouredCloud {
 public:
  /// Opens the file.
  ///
  /// property     name of the value in the file
  /// comment      a line of a PLY's header, such as what the value is
  /// may_replace  whether an existing file may be replaced
  /// errors       those of OutputFile::create()
  static Result<std::unique_ptr<ColouredCloud>> create(const std::filesystem::path& path,
                                                       std::string property, std::string comment,
                                                       bool may_replace);

  /// Adds a point. A value that is not finite has the colour of no value.
  ///
  /// errors  those of temporary files
  Result<void> add(const Vec3& point, double value);
  /// Adds a triangle by the numbers of its points, from 0 in the order of add(). They may be added
  /// later.
  ///
  /// errors  those of temporary files; kBadInput: a number is above 2^32 - 1
  Result<void> add_triangle(const std::array<std::uint64_t, 3>& points);
  /// Number of points so far.
  std::uint64_t point_count() const { return points_.count(); }

  /// Writes the file and gives it its name. The last call.
  ///
  /// errors  those of OutputFile::write() and commit(), and of temporary files
  Result<void> commit(const ColourScale& colours);

 private:
  struct PointRecord {
    double x, y, z, value;
  };
  using TriangleRecord = std::array<std::uint32_t, 3>;

  ColouredCloud(OutputFile output, const std::filesystem::path& path,
                const std::filesystem::path& directory, std::string property, std::string comment);
  Result<void> write_ply(const ColourScale& colours);
  Result<void> write_npy(const ColourScale& colours);
  Result<void> write_vtp(const ColourScale& colours);
  /// Calls take(rows), which returns Result<void>, for all points as rows of an array.
  template <class Take>
  Result<void> for_each_row_piece(const ColourScale& colours, const Take& take);

  OutputFile output_;
  const std::string extension_;  // with its dot, in small letters
  const std::filesystem::path directory_;
  const std::string property_, comment_;
  RecordSpool<PointRecord> points_;
  RecordSpool<TriangleRecord> triangles_;
};

}  // namespace planetree::tools
