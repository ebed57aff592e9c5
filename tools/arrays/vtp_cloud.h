#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"
#include "storage/spill/spill_file.h"
#include "tools/arrays/column.h"

namespace planetree::tools {

/// Points with columns of numbers, and triangles between them, that become a VTK file of PolyData
/// (.vtp): XML with the arrays appended as raw bytes. Each array is in one piece and its length is
/// in front of it, so that every column waits in a temporary file of its own without a name. Memory
/// does not grow with the number of points.
///
/// source  VTK File Formats, "XML file formats"
class VtpCloud {
 public:
  /// What takes text. False once it takes no more.
  using Write = std::function<Result<bool>(std::string_view)>;

  /// columns    of a row; the one named `points` has three parts and becomes the positions
  /// scalars    name of the column that a viewer shows first
  /// directory  of the temporary files
  VtpCloud(std::vector<Column> columns, std::string points, std::string scalars,
           const std::filesystem::path& directory);

  /// Adds points: whole rows, the columns one behind the other.
  ///
  /// errors  those of temporary files
  Result<void> add(std::span<const std::byte> rows);
  /// Adds a triangle by the numbers of its points, from 0 in the order of add().
  ///
  /// errors  those of temporary files
  Result<void> add_triangle(const std::array<std::uint64_t, 3>& points);
  /// Writes the file: the triangles, or each point as a vertex if there are none. The last call.
  ///
  /// errors  those of temporary files and of `write`
  Result<bool> write_to(const Write& write);

 private:
  // An array of the file.
  struct Array {
    std::string type, name, attributes;
    std::uint64_t bytes = 0;
  };
  Result<void> flush_rows();
  Result<void> flush_triangles();
  [[nodiscard]] Array array_of(std::size_t column) const;
  [[nodiscard]] std::string head() const;
  Result<bool> write_spool(const Write& write, const storage::SpillFile& spool) const;
  Result<bool> write_cells(const Write& write) const;

  const std::vector<Column> columns_;
  const std::string scalars_;
  std::size_t positions_ = 0;  // of columns_
  std::vector<std::unique_ptr<storage::SpillFile>> spools_;
  storage::SpillFile corners_;  // of triangles
  std::vector<std::byte> rows_;
  std::vector<std::uint64_t> new_corners_;
};

}  // namespace planetree::tools
