// Attributes of PLY files, in each encoding and of each type.

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

/// A polygon that its fan does not cover: corner 2 is a dent that hides corner 3 from corner 0.
constexpr int kCorners[5][2] = {{4, 0}, {4, 4}, {1, 1}, {0, 4}, {0, 0}};

/// Writes records of the same numbers as words or bytes.
class Writer {
 public:
  explicit Writer(const char* encoding)
      : is_text_(std::string(encoding) == "ascii"),
        bytes_(std::string(encoding) == "binary_big_endian" ? std::endian::big
                                                            : std::endian::little) {
    bytes_.text("ply\nformat " + std::string(encoding) + " 1.0\n");
  }

  Writer& text(const std::string& text) {
    bytes_.text(text);
    return *this;
  }
  template <class... T>
  Writer& put(T... values) {
    if (is_text_) {
      ((bytes_.text(word(values) + " ")), ...);
    } else {
      (bytes_.put(values), ...);
    }
    return *this;
  }
  void end() {
    if (is_text_) bytes_.text("\n");
  }
  [[nodiscard]] const std::string& str() const { return bytes_.str(); }

 private:
  template <class T>
  static std::string word(T value) {
    return std::to_string(value);
  }

  bool is_text_;
  Bytes bytes_;
};

const char* const kEncodings[] = {"ascii", "binary_little_endian", "binary_big_endian"};

template <class PutVertex, class PutFace>
std::string polygon(const char* encoding, const std::string& of_vertex, const std::string& of_face,
                    const PutVertex& put_vertex, const PutFace& put_face) {
  Writer writer(encoding);
  writer.text("element vertex 5\nproperty float x\nproperty float y\nproperty float z\n" +
              of_vertex + "element face 1\nproperty list uchar int vertex_indices\n" + of_face +
              "end_header\n");
  for (int i = 0; i < 5; ++i) {
    writer.put(static_cast<float>(kCorners[i][0]), static_cast<float>(kCorners[i][1]), 0.0F);
    put_vertex(writer, i);
    writer.end();
  }
  writer.put(std::uint8_t{5}, 0, 1, 2, 3, 4);
  put_face(writer);
  writer.end();
  return writer.str();
}

const auto kNothing = [](auto&&...) {};

/// Reads with much memory and with so little that corners are sorted, and expects the same.
Reading read_both(const std::string& bytes, std::uint32_t keep) {
  return read_kept_twice(bytes, ".ply", keep);
}

/// Lines of attributes, which have no number of a triangle.
std::string attributes_of(const Reading& reading) {
  std::string lines;
  for (std::size_t at = 0; at < reading.log.size();) {
    const std::size_t end = reading.log.find('\n', at) + 1;
    if (reading.log[at] == ' ') lines += reading.log.substr(at, end - at);
    at = end;
  }
  return lines;
}

/// The attributes of corner i are i in red and in u.
std::string line_of(int a, int b, int c) {
  const auto corner = [](int i) {
    return "#0" + std::to_string(i) + "0a0bff " + std::to_string(i) + " 0.5, ";
  };
  return "  " + corner(a) + corner(b) + corner(c) + "value 0\n";
}

TEST(PlyAttributes, OfVerticesFollowTheCornersOfAPolygon) {
  for (const char* const encoding : kEncodings) {
    const std::string bytes = polygon(
        encoding,
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float u\n"
        "property float v\n",
        "",
        [](Writer& writer, int i) {
          writer.put(static_cast<std::uint8_t>(i), std::uint8_t{10}, std::uint8_t{11},
                     static_cast<float>(i), 0.5F);
        },
        kNothing);
    const Reading reading = read_both(bytes, kKeepColor | kKeepUv);
    EXPECT_EQ(reading.error, "") << encoding;
    // Corners are found again by their positions.
    const auto corner_at = [](const std::string& text) {
      for (int i = 0; i < 5; ++i)
        if (text == std::to_string(kCorners[i][0]) + " " + std::to_string(kCorners[i][1]) + " 0")
          return i;
      return -1;
    };
    std::string expected;
    for (std::size_t at = 0; at < reading.log.size();) {
      const std::size_t end = reading.log.find('\n', at);
      const std::string line = reading.log.substr(at, end - at);
      at = end + 1;
      if (line[0] == ' ') continue;
      const std::size_t one = line.find(": ") + 2, two = line.find(", ") + 2,
                        three = line.rfind(", ") + 2;
      expected +=
          line_of(corner_at(line.substr(one, two - 2 - one)),
                  corner_at(line.substr(two, three - 2 - two)), corner_at(line.substr(three)));
    }
    EXPECT_EQ(attributes_of(reading), expected) << encoding;
    EXPECT_NE(expected, line_of(0, 1, 2) + line_of(0, 2, 3) + line_of(0, 3, 4));
    EXPECT_EQ(expected.find("-1"), std::string::npos);
  }
}

/// The attributes of a triangle with vertices of the same properties.
template <class Put>
Reading read_triangle(const char* encoding, const std::string& of_vertex, std::uint32_t keep,
                      const Put& put) {
  return read_both(
      polygon(
          encoding, of_vertex, "", [&](Writer& writer, int) { put(writer); }, kNothing),
      keep);
}

TEST(PlyAttributes, OfOtherTypesAreScaled) {
  for (const char* const encoding : kEncodings) {
    const Reading shorts =
        read_triangle(encoding,
                      "property ushort red\nproperty ushort green\nproperty ushort blue\n"
                      "property ushort alpha\n",
                      kKeepColor, [](Writer& writer) {
                        writer.put(std::uint16_t{65535}, std::uint16_t{257}, std::uint16_t{128},
                                   std::uint16_t{129});
                      });
    EXPECT_EQ(shorts.log.find("#ff010001"), shorts.log.find('#')) << shorts.log;
    const Reading floats =
        read_triangle(encoding,
                      "property float diffuse_red\nproperty double diffuse_green\nproperty float "
                      "diffuse_blue\n",
                      kKeepColor, [](Writer& writer) { writer.put(1.5F, 0.5, -2.0F); });
    EXPECT_EQ(floats.log.find("#ff8000ff"), floats.log.find('#')) << floats.log;
    const Reading letters = read_triangle(
        encoding, "property uchar r\nproperty int g\nproperty short b\nproperty uchar a\n",
        kKeepColor, [](Writer& writer) {
          writer.put(std::uint8_t{7}, std::int32_t{300}, std::int16_t{-5}, std::uint8_t{9});
        });
    EXPECT_EQ(letters.log.find("#07ff0009"), letters.log.find('#')) << letters.log;
  }
}

TEST(PlyAttributes, OfVerticesHaveSeveralNames) {
  for (const char* const names : {"u v", "s t", "texture_u texture_v", "texture_s texture_t"}) {
    const std::string both(names);
    const std::string u = both.substr(0, both.find(' ')), v = both.substr(both.find(' ') + 1);
    for (const char* const encoding : kEncodings) {
      const Reading reading =
          read_triangle(encoding, "property double " + v + "\nproperty float " + u + "\n", kKeepUv,
                        [](Writer& writer) { writer.put(0.25, 0.5F); });
      EXPECT_NE(reading.log.find("#000000ff 0.5 0.25, "), std::string::npos) << reading.error;
    }
  }
}

TEST(PlyAttributes, OfFacesHoldForTheirCorners) {
  for (const char* const encoding : kEncodings) {
    const std::string bytes =
        polygon(encoding, "",
                "property list uchar float texcoord\nproperty uchar red\nproperty uchar green\n"
                "property uchar blue\nproperty uchar alpha\nproperty int label\n",
                kNothing, [](Writer& writer) {
                  writer.put(std::uint8_t{10});
                  for (int i = 0; i < 5; ++i) writer.put(static_cast<float>(i), 0.5F);
                  writer.put(std::uint8_t{1}, std::uint8_t{2}, std::uint8_t{3}, std::uint8_t{4},
                             std::int32_t{-7});
                });
    for (const std::uint64_t memory : {MeshScratch::kMemoryBytes, std::uint64_t{0}}) {
      const TemporaryFile file(bytes, ".ply");
      MeshScratch scratch(memory);
      const Reading reading =
          read_input(file.path(), scratch, {.keep = kAllAttributes, .value_property = "label"});
      ASSERT_TRUE(reading.summary) << reading.error;
      EXPECT_EQ(reading.summary->value_kind, ValueKind::kSigned);
      EXPECT_EQ(notes_of(reading), "");
      const std::string lines = attributes_of(reading);
      EXPECT_NE(lines.find("#01020304 3 0.5, "), std::string::npos) << reading.log;
      EXPECT_NE(lines.find("value 18446744073709551609\n"), std::string::npos) << lines;
      EXPECT_EQ(lines.find("#000000ff"), std::string::npos);
    }
  }
}

TEST(PlyAttributes, OfVerticesArePreferred) {
  const std::string color = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  for (const char* const encoding : kEncodings) {
    const std::uint8_t one{1}, two{2};
    const std::string bytes = polygon(
        encoding, color, color, [&](Writer& writer, int) { writer.put(one, one, one); },
        [&](Writer& writer) { writer.put(two, two, two); });
    const Reading reading = read_both(bytes, kKeepColor);
    EXPECT_NE(reading.log.find("#010101ff"), std::string::npos) << reading.error;
    EXPECT_EQ(reading.log.find("#020202ff"), std::string::npos);
  }
}

TEST(PlyAttributes, OfListsOfAWrongLengthAreZeroAndNoted) {
  for (const char* const encoding : kEncodings) {
    const std::string bytes =
        polygon(encoding, "", "property list uchar float texcoord\n", kNothing,
                [](Writer& writer) { writer.put(std::uint8_t{3}, 1.0F, 1.0F, 1.0F); });
    const Reading reading = read_both(bytes, kKeepUv);
    EXPECT_NE(reading.log.find("#000000ff 0 0, #000000ff 0 0, #000000ff 0 0, "), std::string::npos);
    EXPECT_EQ(notes_of(reading),
              "1 face whose 'texcoord' has not two numbers for each corner, the first face 0, "
              "taken with zeros\n");
  }
}

TEST(PlyAttributes, OfVerticesWithListsAreRead) {
  for (const char* const encoding : kEncodings) {
    const Reading reading = read_triangle(
        encoding, "property list uchar int more\nproperty float s\nproperty float t\n", kKeepUv,
        [](Writer& writer) { writer.put(std::uint8_t{1}, 17, 0.5F, 0.25F); });
    EXPECT_NE(reading.log.find("#000000ff 0.5 0.25, "), std::string::npos) << reading.error;
  }
}

template <class T>
std::string value_of(const char* type, T value) {
  std::string lines;
  for (const char* const encoding : kEncodings) {
    const Reading reading =
        read_both(polygon(encoding, "", "property " + std::string(type) + " value\n", kNothing,
                          [&](Writer& writer) { writer.put(value); }),
                  kKeepValue);
    const std::size_t at = reading.log.find("value ");
    EXPECT_NE(at, std::string::npos) << reading.error;
    const std::string line = reading.log.substr(at, reading.log.find('\n', at) - at);
    EXPECT_TRUE(lines.empty() || lines == line) << encoding;
    lines = line;
  }
  return lines;
}

TEST(PlyAttributes, KeepAllBitsOfValues) {
  EXPECT_EQ(value_of("ulong", ~std::uint64_t{1}), "value 18446744073709551614");
  EXPECT_EQ(value_of("uchar", std::uint8_t{200}), "value 200");
  EXPECT_EQ(value_of("char", std::int8_t{-1}), "value 18446744073709551615");
  EXPECT_EQ(value_of("float", 0.5F), "value " + std::to_string(std::bit_cast<std::uint64_t>(0.5)));
}

TEST(PlyAttributes, ThatAreMissingAreRefused) {
  const std::string bytes = polygon("ascii", "", "", kNothing, kNothing);
  const Reading color = read_kept(bytes, ".ply", kKeepColor);
  EXPECT_EQ(color.code, ErrorCode::kBadInput);
  EXPECT_EQ(color.error,
            "no colours: no vertex or face property 'red', 'green', 'blue', nor 'diffuse_red' and "
            "so on, nor 'r', 'g', 'b'; build the mesh without --keep color");
  EXPECT_EQ(read_kept(bytes, ".ply", kKeepUv).error,
            "no texture coordinates: no vertex property 'u', 'v', nor 's', 't', 'texture_u' or "
            "'texture_s', and no face list 'texcoord'; build the mesh without --keep uv");
  EXPECT_EQ(read_kept(bytes, ".ply", kKeepValue).error,
            "no face property 'value'; faces have none; vertices have x, y, z; build the mesh "
            "without --keep value");
}

/// The error of faces without 'value', in a PLY whose vertices and faces have these properties too.
std::string error_without_value(const std::string& of_vertex, const std::string& of_face) {
  return read_kept(polygon("ascii", of_vertex, of_face, kNothing, kNothing), ".ply", kKeepValue)
      .error;
}

TEST(PlyAttributes, NameWhatFacesAndVerticesHave) {
  EXPECT_EQ(error_without_value("property float value\nproperty float nx\n",
                                "property list uchar float value\nproperty int part\n"
                                "property float area\n"),
            "no face property 'value'; faces have part, area; vertices have value, x, y, z, nx; "
            "name one of faces by --value");
  EXPECT_EQ(error_without_value("",
                                "property int first_of_them_all\nproperty int second\n"
                                "property int third\nproperty int fourth\n"),
            "no face property 'value'; faces have first_of_them_all, second, third and 1 more; "
            "vertices have x, y, z; name one of faces by --value");
  std::string many;
  for (int i = 0; i < 1000; ++i)
    many += "property int " + std::string(30, 'n') + std::to_string(i) + "\n";
  EXPECT_TRUE(error_without_value(many, many).ends_with("; name one of faces by --value"));
}

TEST(PlyAttributes, OfStripsAreThoseOfVertices) {
  Writer writer("ascii");
  writer.text(
      "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float u\n"
      "property float v\nelement tristrips 1\nproperty list int int vertex_indices\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int value\n"
      "end_header\n0 0 0 0 1\n1 0 0 1 1\n0 1 0 2 1\n1 1 0 3 1\n4 0 1 2 3 1 1 1 1\n");
  const Reading reading = read_both(writer.str(), kKeepUv);
  EXPECT_EQ(attributes_of(reading),
            "  #000000ff 0 1, #000000ff 1 1, #000000ff 2 1, value 0\n"
            "  #000000ff 2 1, #000000ff 1 1, #000000ff 3 1, value 0\n");
  EXPECT_NE(read_kept(writer.str(), ".ply", kKeepColor).error, "");
  EXPECT_EQ(read_kept(writer.str(), ".ply", kKeepValue).error,
            "no values of triangles: triangle strips have none; build the mesh without --keep "
            "value");
}

}  // namespace
}  // namespace planetree::octree
