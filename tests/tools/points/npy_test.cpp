// Points, rays and sweeps of NumPy arrays.

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/tools/points/points_fixture.h"
#include "tools/points/npy_header.h"

namespace planetree::tools {
namespace {

using namespace std::string_literals;

/// The header of an array, padded as numpy.save does.
std::string header_of(const std::string& type, const std::string& shape,
                      const std::string& order = "False", int version = 1) {
  std::string text =
      "{'descr': '" + type + "', 'fortran_order': " + order + ", 'shape': " + shape + ", }";
  text.resize((text.size() + 10) / 64 * 64 + 64 - 11, ' ');
  text += '\n';
  std::string header = "\x93NUMPY"s + static_cast<char>(version) + '\0';
  for (int i = 0; i < (version == 1 ? 2 : 4); ++i)
    header += static_cast<char>(text.size() >> (8 * i) & 0xff);
  return header + text;
}

template <class Number>
std::string numbers(const std::vector<Number>& values, bool swap = false) {
  std::string text;
  for (const Number value : values) {
    const std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    text += swap ? std::string(bytes.rbegin(), bytes.rend()) : bytes;
  }
  return text;
}

const std::vector<std::vector<double>> kThree = {{1, 2, 3}, {4, 5, 6}, {7, 8, 9}};

class NpyPoints : public Points {};

TEST_F(NpyPoints, AreReadInAllKindsOfNumbers) {
  const std::vector<double> values = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  const auto as = [&]<class Number>(Number) {
    return std::vector<Number>(values.begin(), values.end());
  };
  expect_points(read("a.npy", header_of("<f8", "(3, 3)") + numbers(values)), kThree);
  expect_points(read("b.npy", header_of(">f8", "(3, 3)") + numbers(values, true)), kThree);
  expect_points(read("c.npy", header_of("<f4", "(3, 3)") + numbers(as(1.0f))), kThree);
  expect_points(read("d.npy", header_of(">f4", "(3, 3)") + numbers(as(1.0f), true)), kThree);
  expect_points(read("e.npy", header_of("|i1", "(3, 3)") + numbers(as(std::int8_t{}))), kThree);
  expect_points(read("f.npy", header_of("<u2", "(3, 3)") + numbers(as(std::uint16_t{}))), kThree);
  expect_points(read("g.npy", header_of(">i4", "(3, 3)") + numbers(as(std::int32_t{}), true)),
                kThree);
  expect_points(read("h.npy", header_of("<i8", "(3, 3)") + numbers(as(std::int64_t{}))), kThree);
}

TEST_F(NpyPoints, HaveAnyLeadingShapeAndVersion) {
  const std::vector<double> values = {1, 2, 3, 4, 5, 6, 7, 8, 9};
  expect_points(read("a.npy", header_of("<f8", "(3, 1, 3)") + numbers(values)), kThree);
  expect_points(read("b.npy", header_of("<f8", "(1, 3, 3,)", "False", 2) + numbers(values)),
                kThree);
  expect_points(read("c.npy", header_of("<f8", "(3, 3)", "False", 3) + numbers(values)), kThree);
  expect_points(read("d.npy", header_of("<f8", "(3,)") + numbers(std::vector<double>{1, 2, 3})),
                {{1, 2, 3}});
  expect_points(read("e.npy", header_of("<f8", "(0, 3)")), {});
  expect_points(
      read("f.npy", header_of("<f8", "(1, 3)", "True") + numbers(std::vector<double>{1, 2, 3})),
      {{1, 2, 3}});
}

TEST_F(NpyPoints, AreReadFromStandardInputAndUnderAnyName) {
  const std::string text =
      header_of("<f8", "(3, 3)") + numbers(std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8, 9});
  expect_points(read_input(text), kThree);
  expect_points(read("points.dat", text), kThree);
}

TEST_F(NpyPoints, AreReadInPieces) {
  std::vector<double> values;
  std::vector<std::vector<double>> expected;
  for (int i = 0; i < 10'000; ++i) {
    values.insert(values.end(), {1.0 * i, 2.0 * i, 0.5});
    expected.push_back({1.0 * i, 2.0 * i, 0.5});
  }
  const std::string text = header_of("<f8", "(10000, 3)") + numbers(values);
  for (const std::size_t piece : {1u, 7u, 4096u, 20'000u})
    expect_points(read("a.npy", text, piece), expected);
}

TEST_F(NpyPoints, ThatAreCutOffAreAnErrorAfterTheWholeRows) {
  const std::string text =
      header_of("<f8", "(3, 3)") + numbers(std::vector<double>{1, 2, 3, 4, 5, 6, 7, 8});
  const Reading reading = read("a.npy", text);
  EXPECT_EQ(reading.points.size(), 2u);
  EXPECT_EQ(reading.error, "the NumPy array ends after 2 of 3 rows; copy or save it again");
}

TEST_F(NpyPoints, AreRefusedWhereTheyAreNone) {
  const std::string data(1000, '\0');
  const std::pair<std::string, const char*> cases[] = {
      {header_of("<c16", "(3, 3)"), "has the type '<c16'"},
      {header_of("|O", "(3, 3)"), "has the type '|O'"},
      {header_of("<f2", "(3, 3)"), "has the type '<f2'"},
      {header_of("<f8", "(3, 4)"), "has the shape (3, 4)"},
      {header_of("<f8", "()"), "has no readable shape"},
      {header_of("<f8", "(-1, 3)"), "has no readable shape"},
      {header_of("<f8", "(4294967295, 4294967295, 4294967295, 3)"), "has no readable shape"},
      {header_of("<f8", "(3, 3)", "True"), "in the order of Fortran"},
      {header_of("<f8", "(3, 3)", "False", 9), "unknown version"},
      {header_of("<f8", "(3, 3)").substr(0, 40), "cut off"},
      {"\x93NUMPY\1"s, "cut off"},
  };
  for (const auto& [header, why] : cases) {
    const Reading reading = read("a.npy", header.size() < 64 ? header : header + data);
    EXPECT_TRUE(reading.points.empty()) << why;
    EXPECT_NE(reading.error.find(why), std::string::npos) << reading.error << " / " << why;
    EXPECT_NE(reading.error.find("; "), std::string::npos) << reading.error;
  }
  EXPECT_NE(read("b.npy", header_of("<f8", "(0, 3)"), 2, "1,2,3").error.find("omit it"),
            std::string::npos);
}

TEST_F(NpyPoints, MayBeRaysAndSweeps) {
  const auto read_ways = [&](const std::string& shape, const std::vector<double>& values,
                             auto open) {
    const std::string path = (folder_ / "ways.npy").string();
    std::ofstream(path, std::ios::binary) << header_of("<f8", shape) + numbers(values);
    return open(path, stdin, ColumnChoice());
  };
  auto rays = read_ways("(1, 6)", {1, 2, 3, 4, 5, 6}, open_rays);
  ASSERT_TRUE(rays);
  Ray ray;
  ASSERT_EQ(*(*rays)->read({&ray, 1}), 1u);
  EXPECT_EQ((*rays)->numbers(), 6u);
  EXPECT_EQ(ray.direction.z, 6);
  EXPECT_EQ(ray.t_max, std::numeric_limits<double>::infinity());
  rays = read_ways("(1, 8)", {1, 2, 3, 4, 5, 6, 0.5, 7}, open_rays);
  ASSERT_TRUE(rays);
  ASSERT_EQ(*(*rays)->read({&ray, 1}), 1u);
  EXPECT_EQ(ray.t_min, 0.5);
  EXPECT_EQ(ray.t_max, 7);
  EXPECT_FALSE(read_ways("(1, 7)", {1, 2, 3, 4, 5, 6, 7}, open_rays));
  auto sweeps = read_ways("(1, 7)", {1, 2, 3, 4, 5, 6, 7}, open_sweeps);
  ASSERT_TRUE(sweeps);
  Sweep sweep;
  ASSERT_EQ(*(*sweeps)->read({&sweep, 1}), 1u);
  EXPECT_EQ(sweep.radius, 7);
}

}  // namespace
}  // namespace planetree::tools
