#pragma once

#include <array>
#include <optional>
#include <string>

#include "tools/cli/input_file.h"
#include "tools/points/point_reader.h"

namespace planetree::tools {

/// Points from CSV: x, y and z in the first three columns, or in the columns that a header names.
/// Other columns and empty lines are ignored.
class CsvPoints final : public PointReader {
 public:
  CsvPoints(std::string name, InputFile file)
      : PointReader(std::move(name)), lines_(std::move(file)) {}

  Result<std::size_t> read(std::span<Vec3> points) override;

 private:
  Result<bool> next_point(Vec3& point);
  Error bad_line(const std::string& cause) const;
  bool take_header(std::string_view line);

  LineReader lines_;
  std::array<std::size_t, 3> columns_ = {0, 1, 2};
  bool started_ = false;
  std::optional<Error> pending_;  // reported after the points before it
};

}  // namespace planetree::tools
