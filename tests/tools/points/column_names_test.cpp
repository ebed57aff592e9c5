#include "tools/points/column_names.h"

#include <gtest/gtest.h>

namespace planetree::tools {
namespace {

using Names = std::vector<std::string_view>;

void expect_found(const Names& names, const AxisColumns& expected) {
  AxisColumns columns = {99, 99, 99};
  EXPECT_EQ(find_axes(names, columns), NamedColumns::kOnce) << names[expected[0]];
  EXPECT_EQ(columns, expected) << names[expected[0]];
}

NamedColumns axes_of(const Names& names) {
  AxisColumns columns;
  return find_axes(names, columns);
}

TEST(ColumnNames, FindAxesAsProgramsNameThem) {
  expect_found({"x", "y", "z"}, {0, 1, 2});
  expect_found({"id", "Z", "Y", "X"}, {3, 2, 1});
  expect_found({"id", "X [m]", "Y [m]", "Z [m]"}, {1, 2, 3});
  expect_found({"x(mm)", "y(mm)", "z(mm)"}, {0, 1, 2});
  expect_found({"x_mm", "y_mm", "z_mm"}, {0, 1, 2});
  expect_found({"Point_X", "Point_Y", "Point_Z"}, {0, 1, 2});
  expect_found({"POINTX", "POINTY", "POINTZ"}, {0, 1, 2});
  expect_found({"pos_x", "pos_y", "pos_z"}, {0, 1, 2});
  expect_found({"PosX", "PosY", "PosZ"}, {0, 1, 2});
  expect_found({"Coord.X", "Coord.Y", "Coord.Z"}, {0, 1, 2});
  expect_found({"xcoord", "ycoord", "zcoord"}, {0, 1, 2});
  expect_found({"X-Koordinate", "Y-Koordinate", "Z-Koordinate"}, {0, 1, 2});
  expect_found({"t", "Points:0", "Points:1", "Points:2"}, {1, 2, 3});
  expect_found({"nr", "easting", "northing", "height"}, {1, 2, 3});
  expect_found({"N", "E", "Elevation (m)"}, {1, 0, 2});
  expect_found({"Label", "X/Easting", "Y/Northing", "Z/Altitude"}, {1, 2, 3});
  expect_found({"name", "x", "y", "alt"}, {1, 2, 3});
}

TEST(ColumnNames, ChooseThePositionAmongOtherVectors) {
  expect_found({"nx", "ny", "nz", "x", "y", "z"}, {3, 4, 5});
  expect_found({"n_x", "n_y", "n_z", "x", "y", "z"}, {3, 4, 5});
  expect_found({"Normals:0", "Normals:1", "Normals:2", "Points:0", "Points:1", "Points:2"},
               {3, 4, 5});
  expect_found({"vel_x", "vel_y", "vel_z", "pos_x", "pos_y", "pos_z"}, {3, 4, 5});
  expect_found({"point_x", "point_y", "point_z", "x", "y", "z"}, {3, 4, 5});
}

TEST(ColumnNames, FindNothingElse) {
  EXPECT_EQ(axes_of({"a", "b", "c"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({"x", "y"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({"nx", "ny", "nz"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({"normal_x", "normal_y", "normal_z"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({"0", "1", "2"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({"pos_x", "pos_y", "point_z"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({"X/Northing", "Y/Easting", "Z/Height"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({"x", "y", "time"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({"lon", "lat", "height"}), NamedColumns::kNone);
  EXPECT_EQ(axes_of({}), NamedColumns::kNone);
}

TEST(ColumnNames, RefuseToChooseBetweenEquals) {
  EXPECT_EQ(axes_of({"x", "y", "z", "X"}), NamedColumns::kAmbiguous);
  EXPECT_EQ(axes_of({"x [m]", "y [m]", "z [m]", "x [mm]"}), NamedColumns::kAmbiguous);
  EXPECT_EQ(axes_of({"pos_x", "pos_y", "pos_z", "coord_x", "coord_y", "coord_z"}),
            NamedColumns::kAmbiguous);
  EXPECT_EQ(axes_of({"east", "north", "height", "altitude"}), NamedColumns::kAmbiguous);
  EXPECT_EQ(axes_of({"x", "y", "height", "altitude"}), NamedColumns::kAmbiguous);
}

TEST(ColumnNames, TypedColumnsAreThreeDifferentOnes) {
  EXPECT_TRUE(ColumnChoice::parse("1,2,3"));
  EXPECT_TRUE(ColumnChoice::parse(" a , b b ,7"));
  EXPECT_TRUE(ColumnChoice::parse("1,2,3")->is_numeric());
  EXPECT_FALSE(ColumnChoice::parse("1,2,c")->is_numeric());
  for (const char* text : {"", "1", "1,2", "1,2,3,4", "1,2,2", "0,1,2", "a,,b", "1,2,999999999"}) {
    const auto choice = ColumnChoice::parse(text);
    ASSERT_FALSE(choice) << text;
    EXPECT_EQ(choice.error().code, ErrorCode::kBadArgument);
  }
}

}  // namespace
}  // namespace planetree::tools
