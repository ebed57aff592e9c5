// Triangle strips in PLY files, in all encodings.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

using Lists = std::vector<std::vector<std::int64_t>>;

/// The vertices lie at (i, i * i, 0), so that each has a place of its own.
std::string header(const std::string& format, int vertices, std::size_t lists,
                   const std::string& type) {
  return "ply\nformat " + format + " 1.0\nelement vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement tristrips " +
         std::to_string(lists) + "\nproperty uchar tag\nproperty list int " + type +
         " vertex_indices\nproperty uchar end\nend_header\n";
}

std::string ascii(int vertices, const Lists& lists, const std::string& type) {
  std::string text = header("ascii", vertices, lists.size(), type);
  for (int i = 0; i < vertices; ++i)
    text += std::to_string(i) + " " + std::to_string(i * i) + " 0\n";
  for (const auto& list : lists) {
    text += "7 " + std::to_string(list.size());
    for (const std::int64_t index : list) text += " " + std::to_string(index);
    text += " 8\n";
  }
  return text;
}

std::string binary(int vertices, const Lists& lists, const std::string& type, std::endian order) {
  Bytes bytes(order);
  bytes.text(header(ply_format_name(order), vertices, lists.size(), type));
  for (int i = 0; i < vertices; ++i)
    bytes.put(static_cast<float>(i), static_cast<float>(i * i), 0.0F);
  for (const auto& list : lists) {
    bytes.put(std::uint8_t{7}, static_cast<std::int32_t>(list.size()));
    for (const std::int64_t index : list) {
      if (type == "int64") {
        bytes.put(index);
      } else {
        bytes.put(static_cast<std::int32_t>(index));
      }
    }
    bytes.put(std::uint8_t{8});
  }
  return bytes.str();
}

std::string corner(std::int64_t i) {
  return std::to_string(i) + " " + std::to_string(i * i) + " 0";
}

std::string log_of(const Lists& triangles) {
  std::string log;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    log += std::to_string(i) + ": " + corner(triangles[i][0]) + ", " + corner(triangles[i][1]) +
           ", " + corner(triangles[i][2]) + "\n";
  return log;
}

void expect_triangles(const Lists& strips, const Lists& triangles,
                      const std::string& left_out = "") {
  for (const std::string type : {"int", "uint", "int64"})
    for (const std::string& bytes :
         {ascii(9, strips, type), binary(9, strips, type, std::endian::little),
          binary(9, strips, type, std::endian::big)}) {
      const Reading reading = read_bytes(bytes);
      EXPECT_EQ(reading.error, "");
      EXPECT_EQ(reading.log, log_of(triangles));
      EXPECT_EQ(notes_of(reading).substr(0, left_out.size()), left_out);
      ASSERT_TRUE(reading.summary);
      EXPECT_EQ(reading.summary->face_records, triangles.size());
      EXPECT_EQ(reading.summary->triangle_indices, triangles.size());
      EXPECT_EQ(reading.summary->notes.empty(), left_out.empty());
    }
}

TEST(PlyStrips, TurnsEverySecondTriangle) {
  expect_triangles({{0, 1, 2}}, {{0, 1, 2}});
  expect_triangles({{0, 1, 2, 3}}, {{0, 1, 2}, {2, 1, 3}});
  expect_triangles({{0, 1, 2, 3, 4, 5}}, {{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {4, 3, 5}});
}

TEST(PlyStrips, BeginsAgainBehindMinusOne) {
  expect_triangles({{0, 1, 2, -1, 3, 4, 5}}, {{0, 1, 2}, {3, 4, 5}});
  expect_triangles({{0, 1, 2, 3, -1, 4, 5, 6, 7, -1}},
                   {{0, 1, 2}, {2, 1, 3}, {4, 5, 6}, {6, 5, 7}});
  expect_triangles({{-1, -1, 0, 1, -1, 2, 3, 4, -1, -1}}, {{2, 3, 4}});
}

TEST(PlyStrips, BeginsAgainWithEachList) {
  expect_triangles({{0, 1, 2}, {3, 4, 5}, {6, 7, 8}}, {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
  expect_triangles({{0, 1}, {}, {2}, {3, 4, 5, 6}}, {{3, 4, 5}, {5, 4, 6}});
  expect_triangles({{0, 1, 2, 3, -1}, {4, 5, 6, 7}}, {{0, 1, 2}, {2, 1, 3}, {4, 5, 6}, {6, 5, 7}});
}

// They take no number, and the triangles behind them face as if they had been there.
TEST(PlyStrips, LeavesOutTrianglesThatOnlyLeadOn) {
  expect_triangles({{0, 1, 2, 2, 3, 3, 4, 5}}, {{0, 1, 2}, {4, 3, 5}},
                   "4 triangles of strips with two equal vertices left out");
  expect_triangles({{0, 1, 1, 2, 3}}, {{1, 2, 3}},
                   "2 triangles of strips with two equal vertices left out");
  expect_triangles({{0, 1, 0, 2}}, {{0, 1, 2}},
                   "1 triangle of strips with two equal vertices left out");
}

TEST(PlyStrips, SkipsTrianglesOfMissingVertices) {
  for (const std::string& bytes : {ascii(4, {{0, 1, 2, 9, 3, 2, 1}}, "int"),
                                   binary(4, {{0, 1, 2, 9, 3, 2, 1}}, "int", std::endian::little),
                                   binary(4, {{0, 1, 2, 9, 3, 2, 1}}, "int", std::endian::big)}) {
    const Reading reading = read_bytes(bytes);
    EXPECT_EQ(reading.log,
              "0: 0 0 0, 1 1 0, 2 4 0\n"
              "1+1 aside: face 1: vertex index 9 is out of range, the mesh has 4 vertices\n"
              "2+1 aside: face 2: vertex index 9 is out of range, the mesh has 4 vertices\n"
              "3+1 aside: face 3: vertex index 9 is out of range, the mesh has 4 vertices\n"
              "4: 3 9 0, 2 4 0, 1 1 0\n");
  }
}

TEST(PlyStrips, ReadsStripsInFrontOfVerticesAndOverLines) {
  EXPECT_EQ(
      read_bytes("ply\nformat ascii 1\nelement tristrips 1\nproperty list int int vertex_index\n"
                 "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
                 "element face 0\nproperty list int int vertex_index\nend_header\n"
                 "4\n0 1\n2 3\n0 0 0\n1 1 0\n2 4 0\n3 9 0\n")
          .log,
      log_of({{0, 1, 2}, {2, 1, 3}}));
}

TEST(PlyStrips, RefusesDamage) {
  for (const std::string& bytes :
       {ascii(4, {{0, 1, 2, 3}}, "int"), binary(4, {{0, 1, 2, 3}}, "int", std::endian::little),
        binary(4, {{0, 1, 2, 3}}, "int", std::endian::big)}) {
    EXPECT_EQ(read_bytes(bytes.substr(0, bytes.size() - 3)).code, ErrorCode::kBadInput);
    EXPECT_EQ(read_bytes(bytes + "3 0 1 2").code, ErrorCode::kBadInput);
  }
  EXPECT_EQ(read_bytes(ascii(4, {{0, 1}, {2, -1, 3}}, "int")).error.substr(0, 12), "no triangle:");
}

// With little memory the corners are sorted on disk, from a triangle within a strip on.
TEST(PlyStrips, ReadsTheSameWithLittleMemory) {
  constexpr int kVertices = 4000;
  Lists strips(3);
  std::uint64_t random = 7;
  for (auto& strip : strips)
    for (int i = 0; i < 20000; ++i) {
      random = random * 6364136223846793005 + 1442695040888963407;
      strip.push_back(static_cast<std::int64_t>((random >> 33) % (kVertices + 2)) - 1);
    }
  const std::string texts[] = {ascii(kVertices, strips, "int"),
                               binary(kVertices, strips, "uint", std::endian::little),
                               binary(kVertices, strips, "int64", std::endian::big)};
  const Reading first = read_bytes(texts[0]);
  ASSERT_TRUE(first.summary) << first.error;
  for (const std::string& text : texts)
    for (const std::uint64_t memory_bytes : {std::uint64_t{256}, std::uint64_t{20000}}) {
      const Reading reading = read_bytes(text, "", memory_bytes);
      ASSERT_TRUE(reading.summary) << reading.error;
      EXPECT_TRUE(reading.log == first.log);
      EXPECT_EQ(notes_of(reading).substr(0, 40), notes_of(first).substr(0, 40));
    }
}

}  // namespace
}  // namespace planetree::octree
