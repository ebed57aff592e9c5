#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tools/points/row_reader.h"

/// Shared by the tests of point readers: files of points, and what is read from them.
namespace planetree::tools {

struct Reading {
  std::vector<Vec3> points;
  std::string error;                       ///< empty if the end was reached
  std::uint64_t offset = Error::kNowhere;  ///< of the error
};

class Points : public testing::Test {
 protected:
  /// Reads a file with this text. `columns` is as --columns takes it.
  Reading read(const char* name, const std::string& text, std::size_t piece = 2,
               const char* columns = nullptr) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    ColumnChoice choice;
    if (columns != nullptr) choice = *ColumnChoice::parse(columns);
    return read_all(open_points((folder_ / name).string(), stdin, choice), piece);
  }
  /// Reads standard input with this text.
  static Reading read_input(const std::string& text) {
    std::FILE* const input = std::tmpfile();
    std::fwrite(text.data(), 1, text.size(), input);
    std::rewind(input);
    Reading reading = read_all(open_points("-", input), 2);
    std::fclose(input);
    return reading;
  }
  static Reading read_all(Result<std::unique_ptr<PointReader>> points, std::size_t piece) {
    Reading reading;
    if (!points) {
      reading.error = points.error().text;
      reading.offset = points.error().offset;
      return reading;
    }
    std::vector<Vec3> buffer(piece);
    for (;;) {
      const auto count = (*points)->read(buffer);
      if (!count) {
        reading.error = count.error().text;
        reading.offset = count.error().offset;
        return reading;
      }
      if (*count == 0) return reading;
      reading.points.insert(reading.points.end(), buffer.begin(),
                            buffer.begin() + static_cast<std::ptrdiff_t>(*count));
    }
  }
  static std::string binary_ply(const std::string& header, const std::vector<float>& values,
                                bool swap) {
    std::string text = header;
    for (const float value : values) {
      std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
      text += swap ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
    }
    return text;
  }

  storage::TemporaryDirectory folder_;
};

inline void expect_points(const Reading& reading,
                          const std::vector<std::vector<double>>& expected) {
  EXPECT_EQ(reading.error, "");
  ASSERT_EQ(reading.points.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(reading.points[i].x, expected[i][0]);
    EXPECT_EQ(reading.points[i].y, expected[i][1]);
    EXPECT_EQ(reading.points[i].z, expected[i][2]);
  }
}

}  // namespace planetree::tools
