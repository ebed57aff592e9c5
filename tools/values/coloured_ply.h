#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "planetree/types.h"
#include "storage/spill/spill_file.h"
#include "tools/cli/output_file.h"
#include "tools/values/colour_scale.h"

namespace planetree::tools {

/// A binary PLY file of points with a value and its colour, and of triangles between them.
///
/// Points and triangles wait in temporary files without names, since the colours and the counts are
/// known only at the end. So memory does not grow with their number.
class ColouredPly {
 public:
  /// Opens the file.
  ///
  /// property     name of the value in the file
  /// comment      a line of the header, such as what the value is
  /// may_replace  whether an existing file may be replaced
  /// errors       those of OutputFile::create()
  static Result<std::unique_ptr<ColouredPly>> create(const std::filesystem::path& path,
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
  std::uint64_t point_count() const { return points_.count; }

  /// Writes the file and gives it its name. The last call.
  ///
  /// errors  those of OutputFile::write() and commit(), and of temporary files
  Result<void> commit(const ColourScale& colours);

 private:
  // Records in a temporary file, appended in pieces.
  struct Spool {
    explicit Spool(const std::filesystem::path& directory) : file(directory, kHeldBytes) {}
    Result<void> add(const void* record, std::size_t bytes);
    Result<void> flush();

    static constexpr std::uint64_t kHeldBytes = std::uint64_t{1} << 20;
    storage::SpillFile file;
    std::vector<std::byte> piece;
    std::uint64_t count = 0;
  };

  ColouredPly(OutputFile output, const std::filesystem::path& directory, std::string property,
              std::string comment);
  Result<void> write_points(const ColourScale& colours);
  Result<void> write_triangles();

  OutputFile output_;
  const std::string property_, comment_;
  Spool points_, triangles_;
};

}  // namespace planetree::tools
