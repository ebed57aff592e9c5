// Checks "Caps and cap pages", "Winding numbers" and "Side of a point" as the independent reader
// decodes files.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "planetree/planetree.h"
#include "tests/golden/samples.h"
#include "tests/golden/spec_sides.h"
#include "tests/golden/spec_signs.h"
#include "tests/golden/spec_vector.h"
#include "tests/octree/support/exact_overlap.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::golden {
namespace {

std::vector<SpecTriangle> caps_of(const SpecFile& file) {
  if (!file.header().open()) return {};
  const SpecTree caps(file, SpecTree::Of::kCaps);
  return caps.triangles(caps.root_link());
}

std::vector<SpecTriangle> surface_of(const SpecFile& file) {
  const SpecTree tree(file);
  return tree.triangles(tree.root_link());
}

// The number of edges along which more triangles run in one direction than in the other.
std::size_t unbalanced_edges(const std::vector<std::vector<SpecTriangle>>& parts) {
  std::map<std::pair<SpecPoint, SpecPoint>, int> net;
  for (const std::vector<SpecTriangle>& part : parts)
    for (const SpecTriangle& triangle : part)
      for (std::size_t k = 0; k < 3; ++k) {
        const SpecPoint &from = triangle.corners[k], &to = triangle.corners[(k + 1) % 3];
        if (from < to) ++net[{from, to}];
        if (to < from) --net[{to, from}];
      }
  std::size_t unbalanced = 0;
  for (const auto& [edge, count] : net) unbalanced += count != 0;
  return unbalanced;
}

class SpecCaps : public testing::TestWithParam<Sample> {
 protected:
  SpecCaps()
      : file_(read_file(GetParam().ptree_path())),
        surface_(surface_of(file_)),
        caps_(caps_of(file_)) {}

  const SpecHeader& header() const { return file_.header(); }

  SpecFile file_;
  std::vector<SpecTriangle> surface_, caps_;
};

INSTANTIATE_TEST_SUITE_P(All, SpecCaps, testing::ValuesIn(samples()), sample_name);

TEST_P(SpecCaps, MakeTheSurfaceWatertight) {
  EXPECT_EQ(unbalanced_edges({surface_}), header().unbalanced_edges);
  EXPECT_EQ(unbalanced_edges({surface_, caps_}), 0u);
}

TEST_P(SpecCaps, AreNumberedAndInTheBoxAndHaveTheirArea) {
  std::set<std::uint64_t> numbers;
  double area = 0;
  for (const SpecTriangle& cap : caps_) {
    numbers.insert(cap.id);
    const SpecPoint twice = cross(cap.corners[1] - cap.corners[0], cap.corners[2] - cap.corners[0]);
    area += std::sqrt(dot(twice, twice)) / 2;
    for (const SpecPoint& corner : cap.corners)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double x = std::ldexp(corner[axis], -header().scale_exponent);
        EXPECT_LE(header().box_lower[axis], x);
        EXPECT_GE(header().box_upper[axis], x);
      }
  }
  EXPECT_EQ(numbers.size(), header().cap_count);
  EXPECT_EQ(caps_.size(), header().cap_count);
  if (!numbers.empty()) {
    EXPECT_EQ(*numbers.rbegin(), header().cap_count - 1);
  }
  EXPECT_NEAR(header().cap_area, area, 1e-12);
}

// Random points in the model frame, in the box and around it.
class RandomPoints {
 public:
  explicit RandomPoints(const SpecHeader& header) : header_(header) {}

  SpecPoint next() {
    SpecPoint point{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double share = static_cast<double>(random_() >> 11) * 0x1p-53 * 1.5 - 0.25;
      const double edge = header_.box_upper[axis] - header_.box_lower[axis];
      point[axis] = std::ldexp(header_.box_lower[axis] + share * edge, header_.scale_exponent);
    }
    return point;
  }

 private:
  const SpecHeader& header_;
  std::mt19937_64 random_{12};
};

// Sides that the library finds, of points in the model frame.
class LibrarySides {
 public:
  explicit LibrarySides(const std::filesystem::path& path)
      : model_(Model::open(path)),
        probe_(Probe::create(*model_)),
        back_(-SpecFile(read_file(path)).header().scale_exponent) {}

  Side side(const SpecPoint& p) {
    const Vec3 query = {std::ldexp(p[0], back_), std::ldexp(p[1], back_), std::ldexp(p[2], back_)};
    return probe_->closest_point(query, {.side_rule = SideRule::kSolid}).side;
  }

 private:
  Result<Model> model_;
  Result<Probe> probe_;
  int back_;
};

// Compares the sides of points with sums of solid angles over the whole surface, and with the
// library. Returns how often each side was found.
std::map<SpecSide, int> compare_sides(const SpecFile& file, const std::filesystem::path& path,
                                      const std::vector<SpecTriangle>& surface) {
  const SpecHeader& header = file.header();
  const SpecSides sides(file);
  LibrarySides library(path);
  std::map<SpecSide, int> seen;
  RandomPoints points(header);
  for (int i = 0; i < 1000; ++i) {
    const SpecPoint p = points.next();
    const double w = winding_number(surface, p);
    const SpecSide side = sides.side(p);
    ++seen[side];
    const Side answer = library.side(p);
    if (side == SpecSide::kUnknown) {
      EXPECT_EQ(answer, Side::kUnknown);
      continue;
    }
    if (std::fabs(std::fabs(w) - 0.5) < 1e-9) continue;
    EXPECT_EQ(side, std::fabs(w) > 0.5 ? SpecSide::kInside : SpecSide::kOutside) << w;
    EXPECT_EQ(answer, std::fabs(w) > 0.5 ? Side::kInside : Side::kOutside) << w;
  }
  return seen;
}

TEST_P(SpecCaps, TellTheSidesThatSolidAnglesTell) {
  std::map<SpecSide, int> seen = compare_sides(file_, GetParam().ptree_path(), surface_);
  EXPECT_GT(seen[SpecSide::kOutside], 100);
  EXPECT_EQ(seen[SpecSide::kUnknown], 0);
  EXPECT_EQ(seen[SpecSide::kInside] > 50, GetParam().mesh != sheet_sample().mesh);
}

TEST(SpecCapsOfRegions, TellTheSidesOfTheWholeSurface) {
  const storage::TemporaryDirectory folder;
  const octree::RegionBox box{{-6, -20, 2}, {20, 20, 15}};
  storage::write_bytes(folder / "part.ptree", build_bytes(tube_sample().mesh_path(), 4096, 1, box));
  const SpecFile file(read_file(folder / "part.ptree"));
  const SpecFile whole(read_file(tube_sample().ptree_path()));
  EXPECT_TRUE(file.header().has_walls());
  EXPECT_LT(file.header().triangle_count, whole.header().triangle_count);
  EXPECT_EQ(file.header().cap_count, whole.header().cap_count);
  std::map<SpecSide, int> seen = compare_sides(file, folder / "part.ptree", surface_of(whole));
  for (const SpecSide side : {SpecSide::kInside, SpecSide::kOutside, SpecSide::kUnknown})
    EXPECT_GT(seen[side], 50);
}

// Triangles that touch nothing, each with a cap that has it as its other side.
TEST(SpecCapsOfLooseTriangles, TellTheSidesThatSolidAnglesTell) {
  const storage::TemporaryDirectory folder;
  storage::write_bytes(folder / "loose.ptree", build_loose_sphere());
  const SpecFile file(read_file(folder / "loose.ptree"));
  const std::vector<SpecTriangle> surface = surface_of(file), caps = caps_of(file);
  EXPECT_EQ(caps.size(), surface.size());
  EXPECT_GT(file.header().cap_pages, 2u);
  EXPECT_EQ(unbalanced_edges({surface}), file.header().unbalanced_edges);
  EXPECT_EQ(unbalanced_edges({surface, caps}), 0u);
  std::map<SpecSide, int> seen = compare_sides(file, folder / "loose.ptree", surface);
  EXPECT_GT(seen[SpecSide::kInside], 50);
  EXPECT_GT(seen[SpecSide::kOutside], 50);
}

// The holes of two boxes. Only surfaces with large flat parts have special leaves.
TEST(SpecCapsOfFlatSurfaces, TouchNoSpecialLeaf) {
  const storage::TemporaryDirectory folder;
  storage::write_bytes(folder / "boxes.ptree", build_with_hole(boxes_sample(), 40));
  const SpecFile file(read_file(folder / "boxes.ptree"));
  const std::vector<SpecTriangle> caps = caps_of(file);
  EXPECT_FALSE(caps.empty());
  const SpecMask mask(file);
  const auto to_point = [](const SpecPoint& p) { return octree::Point(p[0], p[1], p[2]); };
  std::size_t special = 0;
  mask.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
    if (record.kind != 4) return;
    ++special;
    for (const SpecTriangle& cap : caps) {
      const octree::Triangle corners{to_point(cap.corners[0]), to_point(cap.corners[1]),
                                     to_point(cap.corners[2])};
      EXPECT_FALSE(octree::exactly_touches(corners, to_point(mask.corner(cell, 0)),
                                           to_point(mask.corner(cell, 7))));
    }
  });
  EXPECT_GT(special, 0u);
  std::map<SpecSide, int> seen = compare_sides(file, folder / "boxes.ptree", surface_of(file));
  EXPECT_GT(seen[SpecSide::kInside], 50);
  EXPECT_GT(seen[SpecSide::kOutside], 50);
}

// A cube without its lid, whose rim is not flat.
// turn  0 to 23: which axis is up, and which axes are mirrored.
void write_open_cube(const std::filesystem::path& path, int turn) {
  constexpr int kCorners[8][3] = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0},
                                  {0, 0, 8}, {8, 0, 6}, {8, 8, 8}, {0, 8, 6}};
  std::ofstream mesh(path);
  for (const auto& corner : kCorners) {
    mesh << 'v';
    for (int axis = 0; axis < 3; ++axis)
      mesh << ' ' << corner[(axis + turn) % 3] * ((turn / 3 >> axis & 1) != 0 ? -1 : 1);
    mesh << '\n';
  }
  mesh << "f 1 2 6\nf 1 6 5\nf 2 3 7\nf 2 7 6\nf 3 4 8\nf 3 8 7\nf 4 1 5\nf 4 5 8\nf 1 4 3\nf 1 3 "
          "2\n";
}

std::ptrdiff_t count_on(const std::vector<SpecTriangle>& triangles, const SpecPoint& p) {
  return std::ranges::count_if(
      triangles, [&p](const SpecTriangle& triangle) { return is_on(p, triangle.corners); });
}

// Points of a triangle that are exact for corners that are small whole numbers.
std::vector<SpecPoint> points_on(const SpecTriangle& triangle) {
  const auto& [a, b, c] = triangle.corners;
  std::vector<SpecPoint> points;
  for (int u = 0; u <= 8; ++u)
    for (int v = 0; u + v <= 8; ++v) {
      SpecPoint& point = points.emplace_back();
      for (std::size_t axis = 0; axis < 3; ++axis)
        point[axis] = ((8 - u - v) * a[axis] + u * b[axis] + v * c[axis]) / 8;
    }
  return points;
}

// The direction of the infinitesimal step differs from turn to turn, relative to the caps.
TEST(SpecCapsWithPointsOnThem, TellTheSidesThatSolidAnglesTell) {
  const storage::TemporaryDirectory folder;
  int on_one = 0, on_both = 0;
  for (int turn = 0; turn < 24; ++turn) {
    write_open_cube(folder / "cube.obj", turn);
    storage::write_bytes(folder / "cube.ptree", build_bytes(folder / "cube.obj", 4096, 1));
    const SpecFile file(read_file(folder / "cube.ptree"));
    const std::vector<SpecTriangle> surface = surface_of(file), caps = caps_of(file);
    ASSERT_EQ(caps.size(), 2u);
    const SpecSides sides(file);
    LibrarySides library(folder / "cube.ptree");
    for (const SpecTriangle& cap : caps)
      for (const SpecPoint& p : points_on(cap)) {
        if (count_on(surface, p) > 0) {
          EXPECT_EQ(sides.side(p), SpecSide::kOnSurface);
          EXPECT_EQ(library.side(p), Side::kOnSurface);
          continue;
        }
        ++(count_on(caps, p) == 2 ? on_both : on_one);
        const double w = std::fabs(winding_number(surface, p));
        ASSERT_GT(std::fabs(w - 0.5), 1e-9);
        EXPECT_EQ(sides.side(p), w > 0.5 ? SpecSide::kInside : SpecSide::kOutside) << w;
        EXPECT_EQ(library.side(p), w > 0.5 ? Side::kInside : Side::kOutside) << w;
      }
  }
  EXPECT_GT(on_one, 500);
  EXPECT_GT(on_both, 100);
}

}  // namespace
}  // namespace planetree::golden
