// Tables of numbers as NumPy arrays and VTK files.

#include <gtest/gtest.h>

#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/arrays/read_npy.h"
#include "tests/tools/arrays/read_vtp.h"
#include "tools/arrays/npy_array.h"
#include "tools/arrays/vtp_cloud.h"

namespace planetree::tools {
namespace {

const std::vector<Column> kTable = {{"place", NumberType::kFloat64, {"x", "y", "z"}},
                                    {"index", NumberType::kInt64},
                                    {"is_good", NumberType::kBool},
                                    {"colour", NumberType::kUint8, {"red", "green", "blue"}}};

/// Row i of the table: (i, i + 0.5, -i), i - 1, whether i is odd, (1, 2, i modulo 256).
std::string table_row(std::size_t i) {
  const double place[] = {static_cast<double>(i), static_cast<double>(i) + 0.5,
                          -static_cast<double>(i)};
  const std::int64_t index = static_cast<std::int64_t>(i) - 1;
  std::string row(sizeof place + sizeof index, '\0');
  std::memcpy(row.data(), place, sizeof place);
  std::memcpy(row.data() + sizeof place, &index, sizeof index);
  row += static_cast<char>(i % 2);
  return row + '\1' + '\2' + static_cast<char>(i);
}

std::span<const std::byte> table_bytes(const std::string& text) {
  return std::as_bytes(std::span(text));
}

TEST(NpyArray, HasAFieldForEachNumber) {
  const ReadNpy array = read_npy(npy_header_text(kTable, 2) + table_row(0) + table_row(301));
  EXPECT_EQ(array.names(), "x,y,z,index,is_good,red,green,blue");
  EXPECT_EQ(array.type_of("y"), "<f8");
  EXPECT_EQ(array.type_of("index"), "<i8");
  EXPECT_EQ(array.type_of("is_good"), "|b1");
  EXPECT_EQ(array.type_of("blue"), "|u1");
  EXPECT_EQ(array.columns.at("y"), (std::vector<double>{0.5, 301.5}));
  EXPECT_EQ(array.columns.at("index"), (std::vector<double>{-1, 300}));
  EXPECT_EQ(array.columns.at("is_good"), (std::vector<double>{0, 1}));
  EXPECT_EQ(array.columns.at("blue"), (std::vector<double>{0, 45}));
}

TEST(NpyArray, HasAHeaderOfOneLengthInMultiplesOf64) {
  std::vector<Column> columns;
  for (int i = 0; i < 70; ++i) {
    columns.push_back({"c" + std::to_string(i)});
    const std::size_t length = npy_header_text(columns, 0).size();
    EXPECT_EQ(length % 64, 0u);
    for (const std::uint64_t rows :
         {std::uint64_t{9}, std::uint64_t{1} << 40, std::numeric_limits<std::uint64_t>::max()})
      EXPECT_EQ(npy_header_text(columns, rows).size(), length) << rows;
  }
}

class VtpCloudTest : public testing::Test {
 protected:
  std::string written(std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
    std::string text;
    const auto result = cloud_.write_to([&](std::string_view more) -> Result<bool> {
      text += more;
      return text.size() < most;
    });
    EXPECT_TRUE(result);
    EXPECT_EQ(result && *result, text.size() < most);
    return text;
  }

  storage::TemporaryDirectory folder_;
  VtpCloud cloud_{kTable, "place", "index", folder_ / "."};
};

TEST_F(VtpCloudTest, HasEveryColumnInOnePieceAndEveryPointAsAVertex) {
  constexpr std::size_t kRows = 100'000;  // many pieces, and more than is held in memory
  std::string rows;
  for (std::size_t i = 0; i < kRows; ++i) {
    rows += table_row(i);
    if (i % 1000 != 999) continue;
    ASSERT_TRUE(cloud_.add(table_bytes(rows)));
    rows.clear();
  }
  const ReadVtp file = read_vtp(written());
  EXPECT_EQ(file.points, kRows);
  EXPECT_EQ(file.verts, kRows);
  EXPECT_EQ(file.polys, 0u);
  EXPECT_EQ(file.scalars, "index");
  EXPECT_EQ(file.arrays.size(), 6u);
  EXPECT_EQ(file.arrays.at("Points").components, 3u);
  EXPECT_EQ(file.arrays.at("PointData/colour").components, 3u);
  EXPECT_EQ(file.arrays.at("PointData/is_good").type, "UInt8");
  const auto& places = file.values("Points");
  const auto& indices = file.values("PointData/index");
  const auto& goods = file.values("PointData/is_good");
  const auto& colours = file.values("PointData/colour");
  const auto& corners = file.values("Verts/connectivity");
  const auto& ends = file.values("Verts/offsets");
  ASSERT_EQ(places.size(), 3 * kRows);
  ASSERT_EQ(colours.size(), 3 * kRows);
  for (const auto* const values : {&indices, &goods, &corners, &ends})
    ASSERT_EQ(values->size(), kRows);
  for (std::size_t i = 0; i < kRows; ++i) {
    const auto number = static_cast<double>(i);
    ASSERT_EQ(places[3 * i + 1], number + 0.5);
    ASSERT_EQ(indices[i], number - 1);
    ASSERT_EQ(goods[i], static_cast<double>(i % 2));
    ASSERT_EQ(colours[3 * i + 2], static_cast<double>(i % 256));
    ASSERT_EQ(corners[i], number);
    ASSERT_EQ(ends[i], number + 1);
  }
}

TEST_F(VtpCloudTest, HasTheTriangles) {
  constexpr std::size_t kTriangles = 30'000;
  ASSERT_TRUE(cloud_.add(table_bytes(table_row(0) + table_row(1) + table_row(2) + table_row(3))));
  for (std::uint64_t i = 0; i < kTriangles; ++i)
    ASSERT_TRUE(cloud_.add_triangle({i % 4, (i + 1) % 4, 3}));
  const ReadVtp file = read_vtp(written());
  EXPECT_EQ(file.points, 4u);
  EXPECT_EQ(file.verts, 0u);
  EXPECT_EQ(file.polys, kTriangles);
  ASSERT_EQ(file.values("Polys/connectivity").size(), 3 * kTriangles);
  ASSERT_EQ(file.values("Polys/offsets").size(), kTriangles);
  const auto& corners = file.values("Polys/connectivity");
  const auto& ends = file.values("Polys/offsets");
  for (std::size_t i = 0; i < kTriangles; ++i) {
    ASSERT_EQ(corners[3 * i + 1], static_cast<double>((i + 1) % 4));
    ASSERT_EQ(ends[i], static_cast<double>(3 * (i + 1)));
  }
}

TEST_F(VtpCloudTest, MayBeEmpty) {
  const ReadVtp file = read_vtp(written());
  EXPECT_EQ(file.points, 0u);
  EXPECT_TRUE(file.values("Points").empty());
  EXPECT_TRUE(file.values("Verts/offsets").empty());
}

TEST_F(VtpCloudTest, StopsWhereNothingMoreIsTaken) {
  ASSERT_TRUE(cloud_.add(table_bytes(table_row(7))));
  const std::string part = written(10);
  EXPECT_TRUE(part.starts_with("<?xml"));
  EXPECT_TRUE(part.ends_with("_"));
}

TEST(VtpCloud, TellsThatItsFolderIsMissing) {
  VtpCloud cloud(kTable, "place", "index", "/nowhere/at/all");
  std::string rows;
  while (rows.size() < (std::size_t{1} << 23)) rows += table_row(1);
  const auto added = cloud.add(table_bytes(rows));
  ASSERT_FALSE(added);
  EXPECT_EQ(added.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace planetree::tools
