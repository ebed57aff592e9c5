#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include "planetree/contact.h"
#include "planetree/error.h"
#include "planetree/types.h"
#include "tools/points/column_names.h"

namespace planetree::tools {

/// A source of points, rays or sweeps, read in pieces, so that memory does not grow with their
/// number.
template <class Row>
class RowReader {
 public:
  static constexpr std::size_t kNumbers = sizeof(Row) / sizeof(double);

  /// numbers  how many of a row's numbers the source has
  explicit RowReader(std::string name, std::size_t numbers = kNumbers)
      : name_(std::move(name)), numbers_(numbers) {}
  virtual ~RowReader() = default;

  /// The file's name in messages.
  const std::string& name() const { return name_; }
  /// How many of a row's numbers the source has: all, or all but the optional ones.
  std::size_t numbers() const { return numbers_; }

  /// Fills the front of `rows`, which must not be empty. Returns the number of rows read, 0 at the
  /// end. Numbers may be NaN or infinite; a query with them gives kBadQuery. An error is reported
  /// after all rows before it.
  ///
  /// errors  kBadInput, naming the line or the offset; kReadFailed.
  virtual Result<std::size_t> read(std::span<Row> rows) = 0;

 private:
  std::string name_;
  std::size_t numbers_;
};

using PointReader = RowReader<Vec3>;
using RayReader = RowReader<Ray>;
using SweepReader = RowReader<Sweep>;

/// Whether a file has raw numbers: its extension is .f64, in any case.
[[nodiscard]] bool is_raw_rows(const std::filesystem::path& path);

/// "standard input" for "-", otherwise the path itself.
std::string points_name(const std::string& path);

/// Opens a file of points: raw numbers if its extension is .f64, otherwise PLY, LAS, a NumPy array
/// or text, as its first bytes tell. Standard input is read in the same way.
///
/// path            "-" is standard input
/// standard_input  must outlive the reader
/// choice          the columns of a text
/// errors          kNotFound, kPermission, kReadFailed; kNoSpace: for a PLY from a pipe;
///                 kBadArgument: a choice of columns for what is no text; kBadInput: neither PLY,
///                 LAS, a NumPy array nor a text of points, a damaged header, or one whose columns
///                 are unknown
Result<std::unique_ptr<PointReader>> open_points(const std::string& path, std::FILE* standard_input,
                                                 const ColumnChoice& choice = {});
/// Opens a file of rays: raw numbers, 8 a ray, a NumPy array of 6 or 8 columns, or text. Else as
/// open_points().
Result<std::unique_ptr<RayReader>> open_rays(const std::string& path, std::FILE* standard_input,
                                             const ColumnChoice& choice = {});
/// Opens a file of sweeps: raw numbers, 7 a sweep, a NumPy array of 7 columns, or text. Else as
/// open_points().
Result<std::unique_ptr<SweepReader>> open_sweeps(const std::string& path, std::FILE* standard_input,
                                                 const ColumnChoice& choice = {});

}  // namespace planetree::tools
