#pragma once

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>

#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::tools {

/// A source of points, read in pieces: memory does not grow with their number.
class PointReader {
 public:
  explicit PointReader(std::string name) : name_(std::move(name)) {}
  virtual ~PointReader() = default;

  /// The file as messages name it.
  const std::string& name() const { return name_; }

  /// Fills the front of `points`, which is not empty; returns how many, 0 at
  /// the end. Coordinates may be NaN or infinite: that is for whoever answers.
  /// What is wrong comes after all points in front of it.
  ///
  /// errors  kBadInput, naming the line or the offset; kReadFailed.
  virtual Result<std::size_t> read(std::span<Vec3> points) = 0;

 private:
  std::string name_;
};

/// "standard input" for "-", else the path itself.
std::string points_name(const std::string& path);

/// Opens a file of points. What it is follows from its content (PLY), else its
/// extension (.f64), else it is CSV, as is standard input.
///
/// path            "-" is standard input.
/// standard_input  must outlive the reader.
/// errors          kNotFound, kPermission, kReadFailed; kBadInput for a header
///                 that is damaged.
Result<std::unique_ptr<PointReader>> open_points(const std::string& path,
                                                 std::FILE* standard_input);

}  // namespace planetree::tools
