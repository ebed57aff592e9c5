#include "octree/builder/mesh/ply_header.h"

#include <gtest/gtest.h>

#include <string>

namespace planetree::octree {
namespace {

const std::string kVertex =
    "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFace = "element face 1\nproperty list uchar int vertex_indices\n";

void expect_refused(const std::string& text, const std::string& message) {
  const Result<PlyHeader> header = parse_ply_header(text);
  ASSERT_FALSE(header) << message;
  EXPECT_EQ(header.error().code, ErrorCode::kBadInput);
  EXPECT_NE(std::string(header.error().text).find(message), std::string::npos)
      << "said: " << header.error().text;
}

TEST(PlyHeader, FindsVerticesAndFaces) {
  const std::string text =
      "ply\r\nformat binary_big_endian 1.0\r\ncomment by hand\r\nelement face 7\r\n"
      "property uchar tag\r\nproperty list uint8 uint32 vertex_index\r\nelement vertex 9\r\n"
      "property double z\r\nproperty int16 y\r\nproperty float32 x\r\nend_header\r\n";
  const Result<PlyHeader> header = parse_ply_header(text + "body");
  ASSERT_TRUE(header) << header.error().text;
  EXPECT_EQ(header->encoding, PlyEncoding::kBinaryBigEndian);
  EXPECT_EQ(header->face_element, 0U);
  EXPECT_EQ(header->vertex_element, 1U);
  EXPECT_EQ(header->index_list, 1U);
  EXPECT_EQ(header->faces().count, 7U);
  EXPECT_EQ(header->vertices().count, 9U);
  EXPECT_EQ(header->coordinates, (std::array<std::size_t, 3>{2, 1, 0}));
  EXPECT_EQ(header->coordinate_type(0), ScalarType::kFloat32);
  EXPECT_EQ(header->coordinate_type(1), ScalarType::kInt16);
  EXPECT_EQ(header->coordinate_type(2), ScalarType::kFloat64);
  EXPECT_EQ(header->body.offset, text.size());
  EXPECT_EQ(header->body.line, 12U);
  EXPECT_FALSE(header->float32());
  EXPECT_EQ(header->vertices().offset_of(2), 10U);
  EXPECT_EQ(header->vertices().min_record_bytes(), 14U);
  EXPECT_EQ(header->faces().min_record_bytes(), 2U);
}

TEST(PlyHeader, BodyStartsAfterALoneCarriageReturn) {
  std::string text = "ply\nformat binary_little_endian 1.0\n" + kVertex + kFace + "end_header\n";
  for (char& c : text) c = c == '\n' ? '\r' : c;
  const Result<PlyHeader> header = parse_ply_header(text + "\nbody");
  ASSERT_TRUE(header) << header.error().text;
  EXPECT_EQ(header->body.offset, text.size());
}

// What exporters write that differs from the original description.
TEST(PlyHeader, AcceptsItsDialects) {
  const std::string format = "format ascii 1.0\n", end = "end_header\n";
  for (const std::string& text :
       {"\xEF\xBB\xBFply\n" + format + kVertex + kFace + end,
        "PLY\n" + format + kVertex + kFace + end, "ply\nformat ascii 1\n" + kVertex + kFace + end,
        "ply\nformat ascii\n" + kVertex + kFace + end,
        "ply \n\n" + format + "\ncomment\ncomment a: b\n" + kVertex + "obj_info x\n" + kFace +
            "\n" + end,
        "ply\n\t" + format +
            "ELEMENT vertex 3 \nProperty\tFLOAT x\t\nproperty float32_t y\n"
            "property float z\n" +
            kFace + end}) {
    const Result<PlyHeader> header = parse_ply_header(text);
    ASSERT_TRUE(is_ply(text) && header) << text;
    EXPECT_EQ(header->vertices().count, 3U);
    EXPECT_EQ(header->body.offset, text.size());
  }
}

TEST(PlyHeader, AcceptsEverySpellingOfTheIndices) {
  for (const std::string name : {"vertex_indices", "vertex_index", "vertex_indexes",
                                 "vertexIndices", "vertex_Index", "VERTEX_INDICES"})
    EXPECT_TRUE(parse_ply_header("ply\nformat ascii 1.0\n" + kVertex +
                                 "element face 1\nproperty list uchar int " + name +
                                 "\nend_header\n"))
        << name;
  for (const std::string name : {"vertex", "indices", "vertex_ids"})
    expect_refused("ply\nformat ascii 1.0\n" + kVertex +
                       "element face 1\nproperty list uchar int " + name + "\nend_header\n",
                   "the faces have 0 lists");
}

TEST(PlyHeader, TakesStripsOrFaces) {
  const std::string begin = "ply\nformat ascii 1.0\n" + kVertex, end = "end_header\n";
  const std::string list = "property list int int vertex_indices\n";
  for (const bool has_empty_face : {false, true}) {
    const std::string faces = has_empty_face ? "element face 0\n" + list : "";
    const auto header = parse_ply_header(begin + faces + "element tristrips 2\n" + list + end);
    ASSERT_TRUE(header);
    EXPECT_TRUE(header->has_strips);
    EXPECT_EQ(header->faces().name, "tristrips");
  }
  const auto faces = parse_ply_header(begin + kFace + "element tristrips 0\n" + list + end);
  ASSERT_TRUE(faces);
  EXPECT_FALSE(faces->has_strips);
}

TEST(PlyHeader, AcceptsBothNamesOfEveryType) {
  const std::pair<const char*, ScalarType> types[] = {
      {"char", ScalarType::kInt8},      {"int8", ScalarType::kInt8},
      {"uchar", ScalarType::kUint8},    {"uint8", ScalarType::kUint8},
      {"short", ScalarType::kInt16},    {"int16", ScalarType::kInt16},
      {"ushort", ScalarType::kUint16},  {"uint16", ScalarType::kUint16},
      {"int", ScalarType::kInt32},      {"int32", ScalarType::kInt32},
      {"uint", ScalarType::kUint32},    {"uint32", ScalarType::kUint32},
      {"float", ScalarType::kFloat32},  {"float32", ScalarType::kFloat32},
      {"double", ScalarType::kFloat64}, {"float64", ScalarType::kFloat64},
      {"long", ScalarType::kInt64},     {"int64", ScalarType::kInt64},
      {"ulong", ScalarType::kUint64},   {"uint64", ScalarType::kUint64},
      {"int64_t", ScalarType::kInt64},  {"uint8_t", ScalarType::kUint8},
      {"UCHAR", ScalarType::kUint8}};
  for (const auto& [name, type] : types) {
    const Result<PlyHeader> header =
        parse_ply_header("ply\nformat ascii 1.0\nelement vertex 3\nproperty " + std::string(name) +
                         " x\nproperty float y\nproperty float z\n" + kFace + "end_header\n");
    ASSERT_TRUE(header) << name;
    EXPECT_EQ(header->coordinate_type(0), type) << name;
    EXPECT_EQ(header->float32(), type == ScalarType::kFloat32 || size_bytes(type) <= 2) << name;
  }
}

TEST(PlyHeader, RefusesUnreadableStatements) {
  const std::string begin = "ply\nformat ascii 1.0\n";
  expect_refused("ply\n", "line 2: the file ends before 'end_header'");
  expect_refused(begin + kVertex + kFace, "line 9: the file ends before 'end_header'");
  expect_refused(begin + "elephant vertex 3\n", "line 3: 'elephant' is no statement");
  expect_refused("ply\nformat ascii 2.0\n", "line 2: format 'ascii 2.0' is unknown");
  expect_refused("ply\nformat binary 1.0\n", "line 2: format 'binary 1.0' is unknown");
  expect_refused(begin + "format ascii 1.0\n", "line 3: a second format");
  expect_refused("ply\n" + kVertex + kFace + "end_header\n", "line 8: the header names no format");
  expect_refused(begin + "element vertex many\n", "line 3: 'many' is no count");
  expect_refused(begin + "element vertex 3x\n", "line 3: '3x' is no count");
  expect_refused(begin + "element vertex -3\n", "line 3: '-3' is no count");
  expect_refused(begin + "element vertex\n", "line 3: '' is no count");
  expect_refused(begin + kVertex + "element vertex 3\n", "line 7: a second element 'vertex'");
  expect_refused(begin + "property float x\n", "line 3: a property in front of all elements");
  expect_refused(begin + "element vertex 3\nproperty half x\n", "line 4: type 'half' is unknown");
  expect_refused(begin + "element vertex 3\nproperty float\n", "line 4: a property without a name");
  expect_refused(begin + "element face 3\nproperty list float int vertex_index\n",
                 "line 4: a list whose length is of no integer type");
}

TEST(PlyHeader, RefusesLayoutsThatAreNoMesh) {
  const std::string begin = "ply\nformat binary_little_endian 1.0\n";
  const std::string end = "end_header\n";
  expect_refused(begin + kFace + end, "no element 'vertex'");
  expect_refused(begin + kVertex + end, "no triangle: the header has no element 'face'");
  expect_refused(begin + kVertex + kFace + "element tristrips 1\n" + end,
                 "both faces and triangle strips: write one of them");
  expect_refused(begin + kVertex + "element tristrips 1\nproperty int vertex_indices\n" + end,
                 "'vertex_indices' is not a list of integers");
  expect_refused(begin + "element vertex 3\nproperty float x\nproperty float y\n" + kFace + end,
                 "the vertices have 0 numbers 'z', not one");
  expect_refused(begin + kVertex + "property float y\n" + kFace + end,
                 "the vertices have 2 numbers 'y', not one");
  expect_refused(begin + kVertex + "element face 1\nproperty int a\n" + end,
                 "the faces have 0 lists 'vertex_indices' or 'vertex_index'");
  expect_refused(begin + kVertex + kFace + "property list uchar int vertex_index\n" + end,
                 "the faces have 2 lists 'vertex_indices' or 'vertex_index'");
  expect_refused(begin + kVertex + "element face 1\nproperty list uchar float vertex_index\n" + end,
                 "'vertex_index' is not a list of integers");
  expect_refused(begin + kVertex + "element face 1\nproperty int vertex_index\n" + end,
                 "'vertex_index' is not a list of integers");
}

}  // namespace
}  // namespace planetree::octree
