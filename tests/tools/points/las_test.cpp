// Points of LAS files.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/tools/points/las_bytes.h"
#include "tests/tools/points/points_fixture.h"

namespace planetree::tools {
namespace {

using namespace std::string_literals;

/// Three points of which no coordinate is like another.
LasFile sample_las(int minor, int format) {
  LasFile file;
  file.minor = minor;
  file.format = format;
  file.points = {{1, -2, 3}, {400, 500, -600}, {2147483647, -2147483647 - 1, 0}};
  file.scale = {0.5, 0.25, 2};
  file.offset = {1000, -1, 0.125};
  return file;
}
const std::vector<std::vector<double>> kSamplePoints = {
    {1000.5, -1.5, 6.125}, {1200, 124, -1199.875}, {1073742823.5, -536870913, 0.125}};

class LasPoints : public Points {};

TEST_F(LasPoints, AreReadInEveryFormatAndVersion) {
  for (int minor = 0; minor <= 4; ++minor)
    for (int format = 0; format <= 10; ++format) {
      SCOPED_TRACE("1." + std::to_string(minor) + ", format " + std::to_string(format));
      expect_points(read("a.las", las_bytes(sample_las(minor, format))), kSamplePoints);
    }
}

TEST_F(LasPoints, AreIntegersTimesTheScalePlusTheOffsetRoundedTwice) {
  LasFile file;
  file.scale = {0.001, 0.01, 1e-7};
  file.offset = {500000.1, 4649776.224, -0.3};
  std::vector<std::vector<double>> expected;
  std::uint32_t state = 1;
  for (int i = 0; i < 5000; ++i) {
    std::array<std::int32_t, 3> point{};
    std::vector<double> position;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      state = state * 1664525 + 1013904223;
      point[axis] = static_cast<std::int32_t>(state);
      const volatile double product = point[axis] * file.scale[axis];
      position.push_back(product + file.offset[axis]);
    }
    file.points.push_back(point);
    expected.push_back(position);
  }
  expect_points(read("a.las", las_bytes(file)), expected);
}

TEST_F(LasPoints, AreFoundBehindWhateverPrecedesThem) {
  LasFile file = sample_las(4, 7);
  file.extra_bytes = 13;
  file.header_extra_bytes = 5;
  file.notes = {{"LASF_Projection", "WKT"}, {"laszip encoder", ""}, {"x", std::string(65535, 'v')}};
  file.gap_bytes = 600'000;
  file.tail = std::string(100, '\x11');
  expect_points(read("a.las", las_bytes(file)), kSamplePoints);
  // A count of records that are not there.
  std::string bytes = las_bytes(sample_las(2, 3));
  put(bytes, 100, std::uint32_t{4000000000});
  expect_points(read("b.las", bytes), kSamplePoints);
  LasFile cut = sample_las(2, 3);
  cut.notes = {{"x", "abc"}};
  bytes = las_bytes(cut);
  put(bytes, 227 + 20, std::uint16_t{65535});
  expect_points(read("c.las", bytes), kSamplePoints);
}

TEST_F(LasPoints, AreReadFromStandardInputAndUnderAnyName) {
  const std::string bytes = las_bytes(sample_las(2, 1));
  expect_points(read_input(bytes), kSamplePoints);
  expect_points(read("points.csv", bytes), kSamplePoints);
}

TEST_F(LasPoints, AreReadInPieces) {
  LasFile file = sample_las(4, 10);
  file.extra_bytes = 300;
  file.points.clear();
  std::vector<std::vector<double>> expected;
  for (std::int32_t i = 0; i < 5'000; ++i) {
    file.points.push_back({2 * i, 4 * i, i});
    expected.push_back({1000.0 + i, i - 1.0, 2.0 * i + 0.125});
  }
  const std::string bytes = las_bytes(file);
  for (const std::size_t piece : {1u, 7u, 4096u, 20'000u})
    expect_points(read("a.las", bytes, piece), expected);
}

TEST_F(LasPoints, AreCountedBy64BitsInVersion4) {
  LasFile file = sample_las(4, 6);
  file.short_count = 0;
  expect_points(read("a.las", las_bytes(file)), kSamplePoints);
  file.short_count = 2;
  expect_points(read("b.las", las_bytes(file)), kSamplePoints);
  file.short_count = kTrueCount;
  file.long_count = 0;
  expect_points(read("c.las", las_bytes(file)), kSamplePoints);
  file.short_count = file.long_count = 0;
  expect_points(read("d.las", las_bytes(file)), {});
  file.long_count = (std::uint64_t{1} << 32) + 3;
  const Reading more = read("e.las", las_bytes(file));
  EXPECT_EQ(more.points.size(), 3u);
  EXPECT_EQ(more.error, "the file ends after 3 of 4294967299 points; copy or export it again");
  // Before 1.4 these bytes are none of the header's.
  LasFile old = sample_las(2, 0);
  old.header_extra_bytes = 200;
  expect_points(read("f.las", las_bytes(old)), kSamplePoints);
}

TEST_F(LasPoints, ThatAreWithheldAreReadLikeOthers) {
  for (const int format : {0, 3, 5, 6, 10}) {
    LasFile file = sample_las(4, format);
    file.withholds = true;
    expect_points(read("a.las", las_bytes(file)), kSamplePoints);
  }
}

TEST_F(LasPoints, ThatAreCompressedAreRefused) {
  const std::string expected =
      "this is LAZ, a LAS file whose points are compressed; decompress it with laszip or PDAL "
      "(pdal translate in.laz out.las)";
  for (const unsigned bits : {0x80u, 0x40u, 0xc0u}) {
    std::string bytes = las_bytes(sample_las(2, 3));
    bytes[104] = static_cast<char>(3 | bits);
    EXPECT_EQ(read("a.laz", bytes).error, expected) << bits;
  }
  LasFile file = sample_las(4, 6);
  file.notes = {{"LASF_Projection", "WKT"}, {"laszip encoded", std::string(40, '\1')}};
  const Reading reading = read("b.laz", las_bytes(file));
  EXPECT_EQ(reading.error, expected);
  EXPECT_TRUE(reading.points.empty());
}

template <class Number>
std::string damaged_las(std::size_t at, Number number, int minor = 4, int format = 6) {
  std::string bytes = las_bytes(sample_las(minor, format));
  put(bytes, at, number);
  return bytes;
}

TEST_F(LasPoints, OfDamagedHeadersAreRefusedByTheByte) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  struct Case {
    std::string bytes;
    std::uint64_t offset;
    const char* cause;
  };
  const Case cases[] = {
      {damaged_las(24, std::uint8_t{2}), 24, "is 2.4, and 1.0 to 1.4 are known"},
      {damaged_las(25, std::uint8_t{5}), 24, "is 1.5, and 1.0 to 1.4 are known"},
      {damaged_las(94, std::uint16_t{374}), 94, "has 374 bytes, but its version has 375"},
      {damaged_las(94, std::uint16_t{234}, 3, 4), 94, "has 234 bytes, but its version has 235"},
      {damaged_las(94, std::uint16_t{226}, 2, 3), 94, "has 226 bytes, but its version has 227"},
      {damaged_las(96, std::uint32_t{374}), 96, "begin at byte 374, within the LAS header"},
      {damaged_las(104, std::uint8_t{11}), 104, "format is 11, and 0 to 10 are known"},
      {damaged_las(104, std::uint8_t{63}), 104, "format is 63, and 0 to 10 are known"},
      {damaged_las(105, std::uint16_t{29}), 105,
       "29 bytes, but those of format 6 have at least 30"},
      {damaged_las(105, std::uint16_t{0}), 105, "0 bytes, but those of format 6"},
      {damaged_las(131, 0.0), 131, "the scale of x is 0,"},
      {damaged_las(139, kNan), 139, "the scale of y is nan,"},
      {damaged_las(147, HUGE_VAL), 147, "the scale of z is inf,"},
      {damaged_las(155, kNan), 155, "the offset of x is nan,"},
      {damaged_las(171, -HUGE_VAL), 171, "the offset of z is -inf,"},
  };
  for (const Case& damage : cases) {
    const Reading reading = read("a.las", damage.bytes);
    EXPECT_TRUE(reading.points.empty()) << damage.cause;
    EXPECT_NE(reading.error.find(damage.cause), std::string::npos)
        << reading.error << " / " << damage.cause;
    EXPECT_NE(reading.error.find("; "), std::string::npos) << reading.error;
    EXPECT_EQ(reading.offset, damage.offset) << reading.error;
  }
}

TEST_F(LasPoints, OfShorterRecordsThanTheFormatsAreRefused) {
  for (int format = 0; format <= 10; ++format) {
    const auto bytes = static_cast<std::uint16_t>(las_record_bytes(format) - 1);
    EXPECT_EQ(read("a.las", damaged_las(105, bytes, 4, format)).offset, 105u) << format;
  }
}

TEST_F(LasPoints, OfTruncatedFilesAreReadUpToTheEnd) {
  LasFile file = sample_las(4, 6);
  file.notes = {{"x", "abc"}};
  const std::string bytes = las_bytes(file);
  const std::size_t records_at = bytes.size() - 3 * las_record_bytes(6);
  for (std::size_t size = 4; size < bytes.size(); ++size) {
    const Reading reading = read("a.las", bytes.substr(0, size));
    EXPECT_EQ(reading.offset, size) << reading.error;
    EXPECT_NE(reading.error.find("; copy or export it again"), std::string::npos) << size;
    EXPECT_EQ(reading.points.size(),
              size < records_at ? 0 : (size - records_at) / las_record_bytes(6))
        << size;
  }
  EXPECT_EQ(read("b.las", bytes.substr(0, records_at - 1)).error,
            "the file ends before its points, which begin at byte " + std::to_string(records_at) +
                "; copy or export it again");
  EXPECT_EQ(read("c.las", bytes.substr(0, bytes.size() - 1)).error,
            "the file ends after 2 of 3 points; copy or export it again");
}

TEST_F(LasPoints, AreNeitherTextNorRaysNorSweeps) {
  const std::string bytes = las_bytes(sample_las(2, 0));
  EXPECT_NE(read("a.las", bytes, 2, "1,2,3").error.find("omit it"), std::string::npos);
  const std::string path = (folder_ / "a.las").string();
  const auto rays = open_rays(path, stdin);
  ASSERT_FALSE(rays);
  EXPECT_EQ(rays.error().text, "this is LAS, which has no rays; give them as CSV, .npy or .f64"s);
  const auto sweeps = open_sweeps(path, stdin);
  ASSERT_FALSE(sweeps);
  EXPECT_EQ(sweeps.error().text,
            "this is LAS, which has no sweeps; give them as CSV, .npy or .f64"s);
}

}  // namespace
}  // namespace planetree::tools
