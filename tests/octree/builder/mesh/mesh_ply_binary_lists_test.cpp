// Binary PLY files with lists among the vertices, and with integers of 64 bits.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

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

void expect_refused(const std::string& bytes, const std::string& message) {
  const Reading reading = read_bytes(bytes);
  EXPECT_FALSE(reading.summary) << message;
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_NE(reading.error.find(message), std::string::npos) << "said: " << reading.error;
}

TEST(PlyBinaryLists, ReadsVerticesWithLists) {
  const std::string list = "property list uchar short tags\n",
                    xyz = "property float x\nproperty double y\nproperty float z\n";
  for (const std::endian order : kOrders)
    for (const bool list_is_first : {true, false})
      for (const std::size_t tags : {0U, 1U, 5U}) {
        Bytes bytes(order);
        bytes.text(header(
            order, "element vertex 3\n" + (list_is_first ? list + xyz : xyz + list) + faces(1)));
        const auto put_list = [&](std::size_t count) {
          bytes.put(static_cast<std::uint8_t>(count));
          for (std::size_t i = 0; i < count; ++i) bytes.put(std::int16_t{-7});
        };
        for (std::size_t i = 0; i < 3; ++i) {
          if (list_is_first) put_list(tags + i);
          bytes.put(i == 1 ? 1.0F : 0.0F).put(i == 2 ? 0.1 : 0.0).put(0.0F);
          if (!list_is_first) put_list(tags + i);
        }
        bytes.put(std::uint8_t{3}).put_all<std::int32_t>({0, 1, 2});
        for (const std::uint64_t memory_bytes : {std::uint64_t{0}, MeshScratch::kMemoryBytes}) {
          const Reading reading = read_bytes(bytes.str(), "", memory_bytes);
          EXPECT_EQ(reading.error, "");
          EXPECT_EQ(reading.log, "0: 0 0 0, 1 0 0, 0 0.10000000000000001 0\n");
        }
        expect_refused(bytes.str() + "more", "4 bytes follow the last record");
        expect_refused(bytes.str().substr(0, bytes.str().size() - 14), "");
      }
}

TEST(PlyBinaryLists, ReadsIntegersOfSixtyFourBits) {
  for (const std::endian order : kOrders)
    for (const std::string name : {"int64", "uint64", "long"}) {
      Bytes bytes(order);
      bytes.text(header(order, "element vertex 3\nproperty int64 x\nproperty " + name +
                                   " y\nproperty ulong z\n" + faces(3, "uint64", name)));
      bytes.put_all<std::int64_t>({-5, 0, 0, std::int64_t{1} << 53, 0, 0, 0, 1, 7});
      bytes.put_all<std::int64_t>({3, 0, 1, 2, 3, 0, 1, std::int64_t{1} << 40, 3, 0, 1, -1});
      const Reading reading = read_bytes(bytes.str());
      EXPECT_EQ(reading.error, "");
      const std::string last = name == "uint64" ? "9223372036854775807" : "-1";
      EXPECT_EQ(
          reading.log,
          "0: -5 0 0, 9007199254740992 0 0, 0 1 7\n"
          "1+1 aside: face 1: vertex index 1099511627776 is out of range, the mesh has 3 vertices\n"
          "2+1 aside: face 2: vertex index " +
              last + " is out of range, the mesh has 3 vertices\n");
    }
}

TEST(PlyBinaryLists, RefusesListsLongerThanAnyFile) {
  for (const std::uint64_t length :
       {std::uint64_t{1} << 32, std::uint64_t{1} << 62, ~std::uint64_t{0}}) {
    Bytes bytes;
    bytes.text(header(std::endian::little, float_vertices(0) + faces(1, "uint64", "int64")));
    bytes.put(length).put_all<std::int64_t>({0, 1, 2});
    expect_refused(bytes.str(), "record 0 of 1 'face' has a bad list length");
  }
}

}  // namespace
}  // namespace planetree::octree
