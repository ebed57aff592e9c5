#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

constexpr std::endian kOrders[] = {std::endian::little, std::endian::big};

std::string header(std::endian order, const std::string& elements) {
  return "ply\nformat " + ply_format_name(order) + " 1.0\n" + elements + "end_header\n";
}

std::string float_vertices(int count) {
  return "element vertex " + std::to_string(count) +
         "\nproperty float x\nproperty float y\nproperty float z\n";
}

std::string faces(int count, const std::string& count_type = "uchar",
                  const std::string& index_type = "int") {
  return "element face " + std::to_string(count) + "\nproperty list " + count_type + " " +
         index_type + " vertex_indices\n";
}

/// Three float vertices and one triangle.
Bytes triangle_file(std::endian order = std::endian::little) {
  Bytes bytes(order);
  bytes.text(header(order, float_vertices(3) + faces(1)));
  bytes.put_all<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  bytes.put<std::uint8_t>(3).put_all<std::int32_t>({0, 1, 2});
  return bytes;
}

void expect_refused(const std::string& bytes, const std::string& message) {
  const Reading reading = read_bytes(bytes);
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

TEST(PlyBinary, ReadsBothByteOrders) {
  for (const std::endian order : kOrders) {
    const Reading reading = read_bytes(triangle_file(order).str());
    EXPECT_EQ(reading.error, "");
    EXPECT_EQ(reading.log, "0: 0 0 0, 1 0 0, 0 1 0\n");
    EXPECT_EQ(reading.summary->vertex_records, 3U);
    EXPECT_TRUE(reading.summary->float32);
  }
}

/// Reads a file with the given types of coordinates, list lengths and indices.
template <class Coordinate, class Count, class Index>
void expect_types(const std::string& coordinate, const std::string& count,
                  const std::string& index) {
  for (const std::endian order : kOrders) {
    Bytes bytes(order);
    bytes.text(header(order, "element vertex 4\nproperty " + coordinate + " x\nproperty " +
                                 coordinate + " y\nproperty " + coordinate + " z\n" +
                                 faces(2, count, index)));
    bytes.put_all<Coordinate>({0, 0, 0, 1, 0, 0, 0, 100, 0, 0, 0, 7});
    bytes.template put<Count>(3).template put_all<Index>({0, 1, 2});
    bytes.template put<Count>(4).template put_all<Index>({3, 2, 1, 0});
    const Reading reading = read_bytes(bytes.str());
    EXPECT_EQ(reading.error, "") << coordinate << count << index;
    EXPECT_EQ(reading.log,
              "0: 0 0 0, 1 0 0, 0 100 0\n"
              "1: 0 0 7, 0 100 0, 1 0 0\n"
              "2: 0 0 7, 1 0 0, 0 0 0\n");
  }
}

TEST(PlyBinary, ReadsEveryTypeForEveryProperty) {
  expect_types<std::int8_t, std::int8_t, std::int8_t>("char", "char", "char");
  expect_types<std::uint8_t, std::uint8_t, std::uint8_t>("uchar", "uchar", "uchar");
  expect_types<std::int16_t, std::int16_t, std::int16_t>("short", "short", "short");
  expect_types<std::uint16_t, std::uint16_t, std::uint16_t>("ushort", "ushort", "ushort");
  expect_types<std::int32_t, std::int32_t, std::int32_t>("int", "int", "int");
  expect_types<std::uint32_t, std::uint32_t, std::uint32_t>("uint", "uint", "uint");
  expect_types<float, std::uint8_t, std::uint32_t>("float", "uchar", "uint");
  expect_types<double, std::int32_t, std::uint16_t>("double", "int", "ushort");
}

TEST(PlyBinary, KeepsEveryBitOfFloatsAndDoubles) {
  Bytes narrow;
  narrow.text(header(std::endian::little, float_vertices(3) + faces(1)));
  narrow.put_all<float>({0.1F, 1e-45F, 3.4028235e38F, -0.0F, 1, 0, 0, 1, -0.0F});
  narrow.put<std::uint8_t>(3).put_all<std::int32_t>({0, 1, 2});
  EXPECT_EQ(read_bytes(narrow.str()).log,
            "0: 0.10000000149011612 1.4012984643248171e-45 3.4028234663852886e+38, 0 1 0, 0 1 0\n");

  Bytes wide;
  wide.text(header(
      std::endian::little,
      "element vertex 3\nproperty double x\nproperty double y\nproperty double z\n" + faces(1)));
  wide.put_all<double>({0.1, 5e-324, 1.7976931348623157e308, -0.0, 1, 0, 0, 1, -0.0});
  wide.put<std::uint8_t>(3).put_all<std::int32_t>({0, 1, 2});
  const Reading reading = read_bytes(wide.str());
  EXPECT_EQ(reading.log,
            "0: 0.10000000000000001 4.9406564584124654e-324 1.7976931348623157e+308, 0 1 0, "
            "0 1 0\n");
  EXPECT_FALSE(reading.summary->float32);
}

TEST(PlyBinary, FindsPropertiesInAnyOrderAmongOthers) {
  for (const std::endian order : kOrders) {
    Bytes bytes(order);
    bytes.text(header(order,
                      "element camera 2\nproperty uchar focus\nproperty list ushort double lens\n"
                      "element pose 1\nproperty double angle\n"
                      "element vertex 3\nproperty uchar red\nproperty double z\nproperty float nx\n"
                      "property float x\nproperty short y\n"
                      "element edge 2\nproperty int vertex1\nproperty list uchar int vertex_index\n"
                      "element nothing 5\n"
                      "element face 2\nproperty list uchar float texcoord\nproperty int material\n"
                      "property list int ushort vertex_index\nproperty list uchar char flags\n"
                      "element tail 1\nproperty list uint uint items\n"));
    using u8 = std::uint8_t;
    using u16 = std::uint16_t;
    bytes.put(u8{1}, u16{2}, 0.5, 0.25).put(u8{1}, u16{0}).put(3.0);
    bytes.put(u8{9}, 3.0, 7.0F, 1.0F, std::int16_t{2});
    bytes.put(u8{9}, 6.0, 7.0F, 4.0F, std::int16_t{-5});
    bytes.put(u8{9}, 0.0, 7.0F, 0.5F, std::int16_t{0});
    bytes.put(8, u8{1}, 99).put(8, u8{0});
    bytes.put(u8{2}, 0.5F, 0.5F, 77, 3, u16{0}, u16{1}, u16{2}, u8{1}, u8{9});
    bytes.put(u8{0}, 77, 3, u16{2}, u16{1}, u16{0}, u8{2}, u8{8}, u8{9});
    bytes.put(std::uint32_t{1}, std::uint32_t{5}).text("\n");
    const Reading reading = read_bytes(bytes.str());
    EXPECT_EQ(reading.error, "");
    EXPECT_EQ(reading.log, "0: 1 2 3, 4 -5 6, 0.5 0 0\n1: 0.5 0 0, 4 -5 6, 1 2 3\n");
  }
}

TEST(PlyBinary, ReadsFacesInFrontOfVertices) {
  for (const std::endian order : kOrders) {
    Bytes bytes(order);
    bytes.text(header(order, faces(2) + float_vertices(3)));
    bytes.put<std::uint8_t>(3).put_all<std::int32_t>({0, 1, 2});
    bytes.put<std::uint8_t>(4).put_all<std::int32_t>({0, 1, 2, 0});
    bytes.put_all<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
    const Reading reading = read_bytes(bytes.str());
    EXPECT_EQ(reading.error, "");
    EXPECT_EQ(reading.log,
              "0: 0 0 0, 1 0 0, 0 1 0\n1: 0 0 0, 1 0 0, 0 1 0\n2: 0 0 0, 0 1 0, 0 0 0\n");
  }
}

TEST(PlyBinary, SkipsBadRecordsAsAWhole) {
  Bytes bytes;
  bytes.text(header(std::endian::little, float_vertices(5) + faces(7, "uint", "int")));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  bytes.put_all<float>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, nan, 0, 0, 0, -infinity});
  bytes.put<std::uint32_t>(3).put_all<std::int32_t>({0, 1, 2});
  bytes.put<std::uint32_t>(6).put_all<std::int32_t>({0, 1, 2, 0, 3, 1});
  bytes.put<std::uint32_t>(3).put_all<std::int32_t>({4, 0, 1});
  bytes.put<std::uint32_t>(4).put_all<std::int32_t>({0, 1, 2, 5});
  bytes.put<std::uint32_t>(3).put_all<std::int32_t>({0, -2147483647 - 1, 2});
  bytes.put<std::uint32_t>(1).put_all<std::int32_t>({0});
  bytes.put<std::uint32_t>(3).put_all<std::int32_t>({2, 1, 0});
  const Reading reading = read_bytes(bytes.str());
  EXPECT_EQ(reading.error, "");
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n"
            "1+4 aside: face 1: vertex 3 is not finite\n"
            "5+1 aside: face 2: vertex 4 is not finite\n"
            "6+2 aside: face 3: vertex index 5 is out of range, the mesh has 5 vertices\n"
            "8+1 aside: face 4: vertex index -2147483648 is out of range, the mesh has 5 vertices\n"
            "9+1 aside: face 5: has 1 corners, fewer than 3\n"
            "10: 0 1 0, 1 0 0, 0 0 0\n");
  EXPECT_EQ(reading.summary->triangle_indices, 11U);
}

TEST(PlyBinary, RefusesEveryTruncation) {
  const std::string whole = triangle_file().str();
  for (std::size_t size = 4; size < whole.size(); ++size) {
    const Reading reading = read_bytes(std::string_view(whole).substr(0, size));
    EXPECT_EQ(reading.code, ErrorCode::kBadInput) << size;
    EXPECT_EQ(reading.log, "") << size;
  }
}

TEST(PlyBinary, ReportsWhereItIsTruncated) {
  const std::string elements = float_vertices(3) + faces(2);
  const std::string head = header(std::endian::little, elements);
  Bytes bytes;
  bytes.text(head).put_all<float>({0, 0, 0, 1, 0, 0, 0, 1});
  const std::string body = std::to_string(head.size());
  expect_refused(bytes.str(), "byte " + body +
                                  ": 3 records 'vertex' of 12 bytes or more do not fit in the 32 "
                                  "left: truncated or miscounted");
  bytes.put<float>(0).put<std::uint8_t>(3).put_all<std::int32_t>({0, 1, 2});
  bytes.put<std::uint8_t>(3).put_all<std::int32_t>({0, 1});
  const Reading reading = read_bytes(bytes.str());
  EXPECT_EQ(reading.offset, head.size() + 36 + 13);
  EXPECT_EQ(reading.error,
            "byte " + std::to_string(head.size() + 49) +
                ": record 1 of 2 'face' has a bad list length or is cut off: truncated or damaged; "
                "copy or export it again");
}

TEST(PlyBinary, RefusesWrongCounts) {
  std::string text = triangle_file().str();
  text.replace(text.find("vertex 3"), 8, "vertex 9223372036854775807");
  expect_refused(text, "9223372036854775807 records 'vertex' of 12 bytes or more do not fit");
  text = triangle_file().str();
  text.replace(text.find("face 1"), 6, "face 99999999999999999999");
  expect_refused(text, "9223372036854775807 records 'face' of 1 bytes or more do not fit");
  text = triangle_file().str();
  text.replace(text.find("face 1"), 6, "face 0");
  expect_refused(text, ": 13 bytes follow the last record: a count in the header is too small");
  text = triangle_file().str();
  text.replace(text.find("element face"), 12,
               "element gap 4611686018427387904\nproperty int a\n"
               "element face");
  expect_refused(text, "4611686018427387904 records 'gap' of 4 bytes or more do not fit");
}

TEST(PlyBinary, RefusesWrongListLengths) {
  Bytes negative;
  negative.text(header(std::endian::little, float_vertices(3) + faces(1, "int", "int")));
  negative.put_all<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  Bytes huge = negative;
  negative.put<std::int32_t>(-3).put_all<std::int32_t>({0, 1, 2});
  expect_refused(negative.str(), "record 0 of 1 'face' has a bad list length");
  huge.put<std::int32_t>(2147483647).put_all<std::int32_t>({0, 1, 2});
  expect_refused(huge.str(), "record 0 of 1 'face' has a bad list length");
}

TEST(PlyBinary, RefusesATruncatedElementBehindTheFaces) {
  Bytes bytes;
  bytes.text(header(std::endian::little, float_vertices(3) + faces(1) +
                                             "element tail 1\nproperty list uchar int items\n"));
  bytes.put_all<float>({0, 0, 0, 1, 0, 0, 0, 1, 0});
  bytes.put<std::uint8_t>(3).put_all<std::int32_t>({0, 1, 2});
  bytes.put<std::uint8_t>(2).put<std::int32_t>(0);
  expect_refused(bytes.str(), "record 0 of 1 'tail' has a bad list length or is cut off");
}

TEST(PlyBinary, RefusesAModelWithoutATriangle) {
  Bytes bytes;
  bytes.text(header(std::endian::little, float_vertices(1) + faces(0)));
  bytes.put_all<float>({0, 0, 0});
  expect_refused(bytes.str(), "no triangle: the mesh has no faces");
  Bytes bad;
  bad.text(header(std::endian::little, float_vertices(0) + faces(1)));
  bad.put<std::uint8_t>(3).put_all<std::int32_t>({0, 1, 2});
  expect_refused(bad.str(),
                 "no triangle: all 1 face records are bad, first face 0: vertex index 0 is out of "
                 "range, the mesh has 0 vertices");
}

}  // namespace
}  // namespace planetree::octree
