#include "tools/points/text_layout.h"

#include <string>
#include <vector>

#include "tests/tools/points/points_fixture.h"

namespace planetree::tools {
namespace {

class PointText : public Points {
 protected:
  void expect_refused(const std::string& text, const std::string& cause,
                      const char* columns = nullptr) {
    const Reading reading = read("refused.txt", text, 2, columns);
    EXPECT_NE(reading.error.find(cause), std::string::npos) << text << reading.error;
    EXPECT_TRUE(reading.points.empty()) << text;
  }
};

const std::vector<std::vector<double>> kTwo = {{1.5, -2, 3e2}, {4, 5, 6}};

TEST_F(PointText, SeparatesByBlanksTabsCommasAndSemicolons) {
  expect_points(read("a.xyz", "1.5 -2 3e2\n4 5 6\n"), kTwo);
  expect_points(read("b.xyz", "   1.5   -2\t 3e2  \n\t4\t5  6\n"), kTwo);
  expect_points(read("c.tsv", "1.5\t-2\t3e2\n4\t5\t6\n"), kTwo);
  expect_points(read("d.csv", "1.5;-2;3e2\n4 ; 5 ; 6 ;\n"), kTwo);
  expect_points(read("e.csv", "1.5,\t-2, 3e2\n4,5,6\n"), kTwo);
  expect_points(read("f.txt", "1.5 -2 3e2 7,7 8,8 9,9\n4 5 6 1,1 1,1 1,1\n"), kTwo);
}

TEST_F(PointText, KeepsEmptyFieldsInTheirColumns) {
  expect_refused("1\t\t3\t4\n", "line 1: ''");
  expect_refused("\t1\t2\t3\n", "line 1: ''");
  expect_refused(",1,2,3\n", "line 1: ''");
  expect_refused("id\tx\ty\tz\tw\n\t1\t\t3\t4\n", "line 2: ''");
  expect_points(read("a.tsv", "id\tx\ty\tz\n\t1.5\t-2\t3e2\n\t4\t5\t6\n"), kTwo);
}

TEST_F(PointText, RefusesRowsThatLackAValueBetweenBlanks) {
  EXPECT_EQ(read("a.txt", "x y z r\n1 2 3 4\n1 3 4\n").error,
            "line 3: it has fewer columns than the first row; give x,y,z, one point a line");
  EXPECT_EQ(read("b.txt", "1 2 3 4 5\n1 3 4 5\n").points.size(), 1u);
  expect_points(read("c.txt", "1.5 -2 3e2 Main Street 7\n4 5 6 Square\n"), kTwo);
  expect_points(read("d.csv", "1.5,-2,3e2,7,8\n4,5,6\n"), kTwo);
}

TEST_F(PointText, EndsLinesInAnyWay) {
  expect_points(read("a.csv", "1.5,-2,3e2\r4,5,6\r"), kTwo);
  expect_points(read("b.csv", "x,y,z\r\n1.5,-2,3e2\r\n4,5,6"), kTwo);
  expect_points(read("c.csv", "x,y,z,w\n1.5,-2,3e2,7\r4,5,6,7\r\n\r\n"), kTwo);
  std::string text;
  std::vector<std::vector<double>> expected;
  for (int i = 0; i < 40000; ++i) {
    text += std::to_string(i) + " 1 2 3" + (i % 3 == 0 ? "\r" : i % 3 == 1 ? "\r\n" : "\n");
    expected.push_back({static_cast<double>(i), 1, 2});
  }
  expect_points(read("d.xyz", text, 1000), expected);
}

TEST_F(PointText, TakesCommentsForHeadersWhereTheyNameColumns) {
  expect_points(read("a.asc", "//X Y Z R G B\n1.5 -2 3e2 1 2 3\n4 5 6 1 2 3\n"), kTwo);
  expect_points(read("b.txt", "# z y x\n3e2,-2,1.5\n6,5,4\n"), kTwo);
  expect_points(read("c.txt", "# scan of Monday\n# nr;x;y;z\n7;1.5;-2;3e2\n8;4;5;6\n"), kTwo);
  expect_points(read("d.txt", "# scan of Monday\n1.5 -2 3e2\n// pause\n4 5 6\n#end\n"), kTwo);
  expect_refused("# id,a,b,c\n7,1.5,-2,3e2\n", "line 1: x, y and z are not among its names 'id'");
  expect_refused("# x y intensity\n1 2 3\n", "'intensity'");
}

TEST_F(PointText, TellsNamesFromProse) {
  expect_points(read("a.txt", "# columns: x y z i\n1.5 -2 3e2 7\n4 5 6 7\n"), kTwo);
  expect_points(read("b.txt", "# columns: z y x\n3e2,-2,1.5\n6,5,4\n"), kTwo);
  expect_points(read("c.txt", "# the x y z of all tips\n1.5 -2 3e2\n4 5 6\n"), kTwo);
  expect_points(read("d.txt", "# x y z of all tips\n1.5,-2,3e2,7\n4,5,6,7\n"), kTwo);
  expect_refused("# the x y z of tips\n1 2 3 4\n", "line 2: the row has 4 columns");
  expect_refused("# the x y z of tips\n1,2,3,4\n", "line 2: the row has 4 columns");
  expect_refused("names x y z\n1,2,3\n", "line 2: the row has 3 columns");
}

TEST_F(PointText, FindsTheHeaderBehindTitles) {
  expect_points(read("a.csv", "Scan of Monday\n\nx,y,z\n1.5,-2,3e2\n4,5,6\n"), kTwo);
  expect_points(read("b.csv", "Monday\nid;X;Y;Z\n7;1.5;-2;3e2\n8;4;5;6\n"), kTwo);
  expect_points(read("c.csv", "x,y,z\n1.5 -2 3e2\n4 5 6\n"), kTwo);
  expect_points(read("d.csv", "sep=;\r\n1.5;-2;3e2\r\n4;5;6\r\n"), kTwo);
  expect_points(read("e.txt", "id X [m] Y [m] Z [m]\n7 1.5 -2 3e2\n8 4 5 6\n"), kTwo);
  expect_points(read("f.txt", "# X (mm) Y (mm) Z (mm)\n1.5 -2 3e2\n4 5 6\n"), kTwo);
  expect_refused("x,y,z\nm,m,m\n1,2,3\n", "line 2: 'm' is not a number");
  expect_refused("Scan of Monday\n1,2,3\n", "line 1: x, y and z are not among its names 'Scan of");
}

TEST_F(PointText, RefusesAHeaderWithoutTheAxes) {
  expect_refused("id,a,b,c\n1,2,3,4\n",
                 "line 1: x, y and z are not among its names 'id', 'a', 'b', 'c' (separator: "
                 "comma); give --columns X,Y,Z by name or number");
  expect_refused("nx\tny\tnz\n1\t2\t3\n", "(separator: tab)");
  expect_refused("x y\n1 2 3\n", "(separator: blank)");
  expect_refused("pos_x;pos_y;pos_z;point_x;point_y;point_z\n1;2;3;4;5;6\n", "more than once");
  std::string many = "id";
  for (int i = 0; i < 500; ++i) many += ",a long name number " + std::to_string(i);
  expect_refused(many + "\n1,2,3\n", "(separator: comma); give --columns");
}

TEST_F(PointText, RefusesNamesThatMayBeShifted) {
  expect_refused("Point Name X Y Z\nA 1 2 3\n", "line 2: the row has 4 columns and the header 5");
  expect_refused("\"x\" \"y\" \"z\"\n\"1\" 1.5 -2 3e2\n", "the row has 4 columns and the header 3");
  expect_refused("\"x\",\"y\",\"z\"\n\"1\",1.5,-2,3e2\n", "the row has 4 columns and the header 3");
  expect_points(read("b.csv", "\"x\",\"y\",\"z\"\n\"1.5\",\"-2\",\"3e2\",\"a\"\n4,5,6,b\n"), kTwo);
  expect_points(read("a.txt", "//X Y Z\n1.5 -2 3e2 0.1\n4 5 6 0.2\n"), kTwo);
}

TEST_F(PointText, TakesColumnsAsTyped) {
  const std::string text = "id,a,b,C [m],d\n7,1.5,-2,3e2,0\n8,4,5,6,0\n";
  expect_points(read("a.csv", text, 2, "a,B,c [m]"), kTwo);
  expect_points(read("b.csv", text, 2, "a,b,c"), kTwo);
  expect_points(read("c.csv", text, 2, "2,3,4"), kTwo);
  expect_points(read("d.csv", text, 2, "a,3,c"), kTwo);
  expect_points(read("e.csv", "z,y,x\n1.5,-2,3e2\n4,5,6\n", 2, "1,2,3"), kTwo);
  expect_points(read("f.txt", "A 1.5 -2 3e2\nB 4 5 6\n", 2, "2,3,4"), kTwo);
  expect_refused(text, "line 1: --columns are not all among its names 'id'", "a,b,e");
  expect_refused(text, "it has a name of --columns more than once", "a,b,3");
  expect_refused("# the a b c of tips\n1 2 3\n", "line 2: the row has 3 columns", "a,b,c");
  expect_refused("1,2,3\n", "it has no header with the names of --columns", "a,b,c");
  expect_refused("1,2,3\n", "line 1: it has fewer than three numbers", "1,2,4");
  expect_refused("A 1 2 3\n", "'A' is not a number; give x,y,z first, or --columns, one point a");
}

TEST_F(PointText, TakesACountInFront) {
  expect_points(read("a.pts", "2\n1.5 -2 3e2 0 1 2 3\n4 5 6 0 1 2 3\n"), kTwo);
  expect_points(read("b.pts", "# Monday\n 2 \r\n1.5,-2,3e2\r\n4,5,6"), kTwo);
  expect_points(read("c.pts", "2\nx y z\n1.5 -2 3e2\n4 5 6"), kTwo);
  const Reading fewer = read("d.pts", "3\n1 2 3\n4 5 6\n");
  EXPECT_EQ(fewer.points.size(), 2u);
  EXPECT_EQ(fewer.error, "line 1 counts 3 points, but there are fewer; correct or omit the count");
  const Reading more = read("e.pts", "1\n1 2 3\n4 5 6\n");
  EXPECT_EQ(more.points.size(), 1u);
  EXPECT_NE(more.error.find("more"), std::string::npos);
  expect_refused("2\n1 2\n3 4\n", "line 1: it has fewer than three numbers");
  expect_refused("1.5\n1 2 3\n", "line 1: it has fewer than three numbers");
}

TEST_F(PointText, ReadsDecimalCommasThatLeaveNoDoubt) {
  expect_points(read("a.csv", "1,5;-2,0;3,0e2\n4,0;5,0;6,0\n"), kTwo);
  expect_points(read("b.txt", "1,5 -2 3e2\n4 5 6\n"), kTwo);
  expect_points(read("c.txt", "id\tx\ty\tz\n1.2\t1,500\t-2,000\t300,000\n1.3\t4,0\t5,0\t6,0\n"),
                kTwo);
  expect_points(read("d.csv", "1,500;-2,000;300,000\n4,000;5,000;6,000\n"), kTwo);
  expect_points(read("f.csv", "\"1,5\",\"-2\",\"3e2\"\n\"4,0\",\"5,0\",\"6\"\n"), kTwo);
  expect_refused("\"1,234\",\"5,678\",\"9,012\"\n", "line 1: '1,234' may have");
  expect_refused("1,5;2;3.5\n", "line 1: '1,5' has a comma where other numbers have a point");
  expect_refused("1,500;2;3\n", "line 1: '1,500' may have a decimal comma or grouped thousands");
  expect_refused("1.234,5;1;2\n", "line 1: '1.234,5' is not a number");
  expect_refused("1,5;2,5;3,5\n1.5;2,5;3,5\n", "line 1: '1,5' has a comma");
  std::string text;
  for (int i = 0; i < 300; ++i) text += "1,5;2,5;3,5\n";
  EXPECT_EQ(read("e.csv", text + "1.5;2,5;3,5\n").error,
            "line 301: '1.5' is not a number; give x,y,z, one point a line");
}

TEST_F(PointText, RefusesRowsItDoesNotUnderstand) {
  for (const char* row :
       {"4,5", "4,5,", "4,5,6x", "4,5,6 7", "4,5,6# note", "4,5,#", "4,5,1.#", "4,5,0x6", "4,5,--6",
        "x,y,z", "4;5;6", "4,\"5,6", "4,\"5\"0,6", "1", ","})
    EXPECT_EQ(read("a.csv", std::string("1,2,3\n1,2,3\n") + row + "\n").error.substr(0, 8),
              "line 3: ")
        << row;
  expect_points(read("b.csv", "\"1.5\",\"-2\",\"3e2\",\"a,\"\"b\"\n4,5,6,\"\n"), kTwo);
  expect_points(read("c.csv", "id,x,y,z\n\"a, b\",1.5,-2,3e2\n\"c\"\"d\",4,5,6\n"), kTwo);
}

TEST_F(PointText, ReadsTheVerticesOfAnObjWithoutFaces) {
  expect_points(read("a.obj", "v 1.5 -2 3e2\nv 4 5 6\n"), kTwo);
  expect_points(read("b.obj", "# points\nv\t1.5 -2 3e2 1 0 0\nv  4 5 6 1 0 0\n"), kTwo);
  expect_refused("v 1 2 3\nv 4 5 6\nf 1 2 1\n", "this is an OBJ mesh");
  std::string text;
  for (int i = 0; i < 300; ++i) text += "v 1 2 3\n";
  EXPECT_NE(read("c.obj", text + "f 1 2 3\n").error.find("line 301: 'f'"), std::string::npos);
}

TEST_F(PointText, RefusesALongFrontWithoutAPoint) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += "# this comment does not end\n";
  expect_refused(text + "1,2,3\n", "its first 262144 bytes have no line with a point");
}

}  // namespace
}  // namespace planetree::tools
