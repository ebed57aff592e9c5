#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "planetree/error.h"
#include "planetree/types.h"
#include "tools/points/column_names.h"

namespace planetree::tools {

/// A source of points, read in pieces, so that memory does not grow with their number.
class PointReader {
 public:
  explicit PointReader(std::string name) : name_(std::move(name)) {}
  virtual ~PointReader() = default;

  /// The file's name in messages.
  const std::string& name() const { return name_; }

  /// Fills the front of `points`, which must not be empty. Returns the number of points read, 0 at
  /// the end. Coordinates may be NaN or infinite; a query with them gives kBadQuery. An error is
  /// reported after all points before it.
  ///
  /// errors  kBadInput, naming the line or the offset; kReadFailed.
  virtual Result<std::size_t> read(std::span<Vec3> points) = 0;

 private:
  std::string name_;
};

/// "standard input" for "-", otherwise the path itself.
std::string points_name(const std::string& path);

/// Opens a file of points: raw numbers if its extension is .f64, otherwise PLY or text, as its
/// first bytes tell. Standard input is read in the same way.
///
/// path            "-" is standard input
/// standard_input  must outlive the reader
/// choice          the columns of a text
/// errors          kNotFound, kPermission, kReadFailed; kNoSpace: for a PLY from a pipe;
///                 kBadArgument: a choice of columns for what is no text; kBadInput: neither PLY
///                 nor a text of points, a damaged header, or one whose columns are unknown
Result<std::unique_ptr<PointReader>> open_points(const std::string& path, std::FILE* standard_input,
                                                 const ColumnChoice& choice = {});

}  // namespace planetree::tools
