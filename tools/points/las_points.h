#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/cli/input_file.h"
#include "tools/points/las_header.h"
#include "tools/points/row_reader.h"

namespace planetree::tools {

/// The positions of all points of a LAS file, those that are flagged as withheld among them. The
/// file is read from front to back, so that it may be a pipe.
class LasPoints final : public PointReader {
 public:
  /// file    at its begin
  /// front   its first bytes, as parse_las_header() takes them
  /// errors  kBadInput: the header is damaged, the file ends before its points, or these are
  ///         compressed. Those of reading the file.
  static Result<std::unique_ptr<PointReader>> create(std::string name, InputFile file,
                                                     std::string_view front);

  Result<std::size_t> read(std::span<Vec3> points) override;

 private:
  LasPoints(std::string name, InputFile file, const LasHeader& header);
  Result<void> skip_to_records();
  Result<void> skip(std::uint64_t bytes);
  Result<std::span<const std::byte>> take(std::size_t bytes);
  Error cut_off() const;

  InputFile file_;
  const LasHeader header_;
  std::vector<std::byte> piece_;
  std::uint64_t offset_ = 0;  // bytes read
  std::uint64_t points_read_ = 0;
  bool is_cut_ = false;  // reported after the points before it
};

}  // namespace planetree::tools
