#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cstdio>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tools/points/row_reader.h"

// Rays and sweeps from files.
namespace planetree::tools {
namespace {

constexpr double kForever = std::numeric_limits<double>::infinity();
using RayNumbers = std::array<double, 8>;
using SweepNumbers = std::array<double, 7>;

template <class Row>
struct ReadWays {
  std::vector<std::array<double, RowReader<Row>::kNumbers>> rows;
  std::size_t numbers = 0;
  std::string error;
};

class WayFiles : public testing::Test {
 protected:
  ReadWays<Ray> rays(const std::string& name, const std::string& text,
                     const char* columns = nullptr) {
    return read<Ray>(open_rays(written(name, text), stdin, choice_of(columns, kRayShape)));
  }
  ReadWays<Sweep> sweeps(const std::string& name, const std::string& text,
                         const char* columns = nullptr) {
    return read<Sweep>(open_sweeps(written(name, text), stdin, choice_of(columns, kSweepShape)));
  }

 private:
  std::string written(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name.c_str(), std::ios::binary) << text;
    return (folder_ / name.c_str()).string();
  }
  static ColumnChoice choice_of(const char* columns, const RowShape& shape) {
    return columns == nullptr ? ColumnChoice() : *ColumnChoice::parse(columns, shape);
  }
  template <class Row>
  static ReadWays<Row> read(const Result<std::unique_ptr<RowReader<Row>>>& reader) {
    ReadWays<Row> all;
    if (!reader) {
      all.error = reader.error().text;
      return all;
    }
    all.numbers = (*reader)->numbers();
    std::vector<Row> piece(2);
    for (;;) {
      const auto count = (*reader)->read(piece);
      if (!count) all.error = count.error().text;
      if (!count || *count == 0) return all;
      for (std::size_t i = 0; i < *count; ++i)
        all.rows.push_back(std::bit_cast<std::array<double, RowReader<Row>::kNumbers>>(piece[i]));
    }
  }

  storage::TemporaryDirectory folder_;
};

const RayNumbers kFirst = {1.5, -2, 3, 0, 0, 1, 0, kForever};
const RayNumbers kRanged = {1.5, -2, 3, 0, 0, 1, 0.25, 8};

TEST_F(WayFiles, ReadRaysWithoutAHeader) {
  for (const char* text :
       {"1.5,-2,3,0,0,1\n", "# rays\n1.5 -2 3 0 0 1\n", "1,5;-2;3;0;0;1\n", "1\n1.5,-2,3,0,0,1,\n",
        "1.5,-2,3,0,0,1,down\n", "\"1,5\"\t-2\t3\t0\t0\t1\n"}) {
    const auto read = rays("a.csv", text);
    EXPECT_EQ(read.error, "") << text;
    EXPECT_EQ(read.rows, std::vector{kFirst}) << text;
    EXPECT_EQ(read.numbers, 6u);
  }
  const auto ranged = rays("b.csv", "1.5,-2,3,0,0,1,0.25,8\n1.5,-2,3,0,0,1,0,inf\n");
  EXPECT_EQ(ranged.error, "");
  EXPECT_EQ(ranged.rows, (std::vector{kRanged, kFirst}));
  EXPECT_EQ(ranged.numbers, 8u);
}

TEST_F(WayFiles, ReadTheColumnsThatAHeaderNames) {
  EXPECT_EQ(rays("a.csv", "id,dx,dy,dz,X [m],Y [m],Z [m]\n7,0,0,1,1.5,-2,3\n").rows,
            std::vector{kFirst});
  EXPECT_EQ(rays("b.csv", "# t_max t_min x y z dx dy dz\n8 0.25 1.5 -2 3 0 0 1\n").rows,
            std::vector{kRanged});
  const auto end = rays("c.csv", "x,y,z,dx,dy,dz,t_max\n1.5,-2,3,0,0,1,8\n");
  EXPECT_EQ(end.rows, (std::vector<RayNumbers>{{1.5, -2, 3, 0, 0, 1, 0, 8}}));
  EXPECT_EQ(end.numbers, 8u);
  const auto names = rays("d.csv", "x,y,z,dx,dy,dz,intensity\n1.5,-2,3,0,0,1,8\n");
  EXPECT_EQ(names.rows, std::vector{kFirst});
  EXPECT_EQ(names.numbers, 6u);
  EXPECT_EQ(sweeps("e.csv", "radius;x1;y1;z1;x0;y0;z0\n0,5;4;5;6;1;2;3\n").rows,
            (std::vector<SweepNumbers>{{1, 2, 3, 4, 5, 6, 0.5}}));
}

TEST_F(WayFiles, ReadChosenColumns) {
  EXPECT_EQ(rays("a.csv", "a,b,c,u,v,w\n1.5,-2,3,0,0,1\n", "a,b,c,u,v,w").rows,
            std::vector{kFirst});
  EXPECT_EQ(rays("b.csv", "1,0,0,3,-2,1.5,8,0.25\n", "6,5,4,3,2,1,8,7").rows, std::vector{kRanged});
  EXPECT_EQ(sweeps("c.csv", "9,1,2,3,4,5,6,0.5\n", "2,3,4,5,6,7,8").rows,
            (std::vector<SweepNumbers>{{1, 2, 3, 4, 5, 6, 0.5}}));
  EXPECT_FALSE(ColumnChoice::parse("1,2,3", kRayShape));
  EXPECT_FALSE(ColumnChoice::parse("1,2,3,4,5,6,7,8", kSweepShape));
}

TEST_F(WayFiles, RefuseRowsNamingTheLine) {
  EXPECT_EQ(rays("a.csv", "1,2,3,4,5,6\n1,2,3,4,5\n").error,
            "line 2: it has fewer than six numbers; give x,y,z,dx,dy,dz, one ray a line");
  EXPECT_EQ(rays("b.csv", "1,2,3,4,5,6,7\n").error,
            "line 1: the row has 7 numbers, and a ray has 6 or 8; name them by a header or "
            "--columns");
  EXPECT_EQ(rays("c.csv", "1,2,3,4,5,6,7,8\n1,2,3,4,5,6\n").error,
            "line 2: it has fewer than eight numbers; give x,y,z,dx,dy,dz, one ray a line");
  EXPECT_EQ(rays("d.csv", "0;0;-5,5;0;0\n").error,
            "line 1: it has fewer than six numbers; give x,y,z,dx,dy,dz, one ray a line");
  EXPECT_EQ(sweeps("e.csv", "0,0,0,1,1,one,2\n1,2,3,4,5,6,7\n").error,
            "line 1: 'one' is not a number; give x0,y0,z0,x1,y1,z1,radius, one sweep a line");
  EXPECT_EQ(sweeps("f.csv", "x,y,z,dx,dy,dz\n1,2,3,4,5,6\n").error,
            "line 1: x0, y0, z0, x1, y1, z1 and radius are not among its names 'x', 'y', 'z', 'dx',"
            " 'dy', 'dz' (separator: comma); name them by a header or --columns");
  EXPECT_EQ(rays("g.csv", "x,y,z,dx,dy,dz,x\n1,2,3,4,5,6,7\n").error,
            "line 1: it names x, y, z, dx, dy or dz more than once; name them by a header or "
            "--columns");
  EXPECT_EQ(rays("h.csv", "2\n1,2,3,4,5,6\n").error,
            "line 1 counts 2 rays, but there are fewer; correct or omit the count");
  EXPECT_EQ(rays("i.ply", "ply\nformat ascii 1.0\n").error,
            "this is PLY, which has no rays; give them as CSV, .npy or .f64");
  EXPECT_EQ(sweeps("j.csv", "{\"x0\": 1}\n").error,
            "this is JSON, not a list of sweeps; save its sweeps as CSV, .npy or .f64");
}

template <class Numbers>
std::string bytes_of(const Numbers& numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), sizeof numbers};
}

TEST_F(WayFiles, ReadRawNumbers) {
  const auto read = rays("a.f64", bytes_of(kRanged) + bytes_of(kFirst));
  EXPECT_EQ(read.rows, (std::vector{kRanged, kFirst}));
  EXPECT_EQ(read.numbers, 8u);
  const SweepNumbers sweep = {1, 2, 3, 4, 5, 6, 0.5};
  EXPECT_EQ(sweeps("b.f64", bytes_of(sweep)).rows, std::vector{sweep});
  const auto cut = rays("c.f64", bytes_of(kFirst) + bytes_of(sweep));
  EXPECT_EQ(cut.rows, std::vector{kFirst});
  EXPECT_EQ(cut.error, "the file ends 56 bytes into a ray of 64 bytes; write whole rays");
}

}  // namespace
}  // namespace planetree::tools
