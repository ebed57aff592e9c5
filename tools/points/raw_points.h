#pragma once

#include <cstdint>
#include <string>

#include "tools/cli/input_file.h"
#include "tools/points/point_reader.h"

namespace planetree::tools {

/// Points as little-endian float64 triples without gaps.
class RawPoints final : public PointReader {
 public:
  RawPoints(std::string name, InputFile file)
      : PointReader(std::move(name)), file_(std::move(file)) {}

  Result<std::size_t> read(std::span<Vec3> points) override;

 private:
  InputFile file_;
  std::uint64_t offset_ = 0;
  std::size_t odd_bytes_ = 0;  // bytes of an incomplete last point
};

}  // namespace planetree::tools
