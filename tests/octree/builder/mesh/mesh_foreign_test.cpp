// Files of formats that no reader reads: they are refused by name, whatever their extension.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "octree/builder/mesh/foreign_format.h"
#include "octree/builder/mesh/mesh_size.h"
#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

using namespace std::string_literals;

std::string name_of(std::string_view file) {
  const auto format = foreign_format(file);
  return format ? std::string(format->name) : "unknown";
}

std::string behind(std::size_t zeros, const std::string& bytes) {
  return std::string(zeros, ' ') + bytes;
}

TEST(ForeignFormat, KnowsCompressedFilesAndArchives) {
  EXPECT_EQ(name_of("\x1f\x8b\x08\0\0"s), "compressed again with gzip");
  EXPECT_EQ(name_of("\x28\xb5\x2f\xfd\x24"s), "compressed again with zstd");
  EXPECT_EQ(name_of("BZh91AY&SY"), "compressed with bzip2");
  EXPECT_EQ(name_of("\xfd\x37zXZ\0\0"s), "compressed with xz");
  EXPECT_EQ(name_of("PK\3\4....mesh.stl"), "a ZIP archive");
  EXPECT_EQ(name_of("PK\3\4....3D/3dmodel.model"), "a 3MF file");
  EXPECT_EQ(name_of("PK\3\4....[Content_Types].xml"), "a 3MF file or another ZIP package");
  EXPECT_EQ(name_of("PK\3\4....scene.usdc"), "a USD package");
  EXPECT_EQ(name_of(behind(257, "ustar\0"s)), "a tar archive");
}

TEST(ForeignFormat, KnowsOtherModels) {
  EXPECT_EQ(name_of("{ \"vertices\": ["), "a JSON file and no glTF");
  EXPECT_EQ(name_of("Kaydara FBX Binary  \0"s), "an FBX file");
  EXPECT_EQ(name_of("; FBX 7.3.0 project file"), "an FBX file in text form");
  EXPECT_EQ(name_of("# vtk DataFile Version 3.0"), "a VTK file");
  EXPECT_EQ(name_of("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">"), "a VTK file");
  EXPECT_EQ(name_of("<?xml version=\"1.0\"?><COLLADA xmlns="), "a Collada file");
  EXPECT_EQ(name_of("\xEF\xBB\xBF <?xml?>\n<other>"), "an XML file");
  EXPECT_EQ(name_of("PXR-USDC\0"s), "a USD file");
  EXPECT_EQ(name_of("#usda 1.0"), "a USD file in text form");
  EXPECT_EQ(name_of("\x89PTREE\r\n"), "a .ptree file");
}

TEST(ForeignFormat, KnowsPointsVolumesAndShapes) {
  EXPECT_EQ(name_of("LASF\0\0"s), "a LAS or LAZ file");
  EXPECT_EQ(name_of("ASTM-E57\1"s), "an E57 file");
  EXPECT_EQ(name_of("# .PCD v0.7 - Point Cloud Data file format"), "a PCD file");
  EXPECT_EQ(name_of(behind(128, "DICM")), "a DICOM file");
  EXPECT_EQ(name_of("ISO-10303-21;\nHEADER;"), "a STEP file");
  EXPECT_EQ(name_of(behind(72, "S      1\n")), "an IGES file");
  EXPECT_EQ(name_of("**ABCDEFGHIJKLMNOPQRSTUVWXYZabc"), "a Parasolid file");
}

TEST(ForeignFormat, KnowsWhatIsNoModel) {
  EXPECT_EQ(name_of("<!DOCTYPE HTML>\n<title>404"), "a web page");
  EXPECT_EQ(name_of("\n<html><body>not found"), "a web page");
  EXPECT_EQ(name_of("version https://git-lfs.github.com/spec/v1\noid"), "a pointer of Git LFS");
  EXPECT_EQ(name_of("\xff\xfep\0l\0y\0"s), "a text in UTF-16");
  EXPECT_EQ(name_of("s\0o\0l\0i\0d\0 \0a\0\n\0"s), "a text in UTF-16");
  EXPECT_EQ(name_of("\0s\0o\0l\0i\0d\0 \0a\0\n"s), "a text in UTF-16");
  EXPECT_EQ(name_of(std::string(4096, '\0')), "nothing but zero bytes so far");
  EXPECT_EQ(name_of("{ OFF\n3 1 0\n"), "an object of Geomview in braces");
  EXPECT_EQ(name_of(""), "empty");
}

TEST(ForeignFormat, KnowsNoMeshThatIsRead) {
  for (const std::string& mesh :
       {"ply\nformat ascii 1.0\n"s, "solid a\nfacet"s, "OFF\n3 1 0\n"s, "# Blender\nv 0 0 0\n"s,
        "mtllib a.mtl\n"s, "8 12 18\n"s, "v 0 0 0\n"s, "P"s, "\x1f"s, "# .P"s})
    EXPECT_EQ(name_of(mesh), "unknown") << mesh;
}

TEST(ForeignFormat, IsRefusedByNameUnderAnyExtension) {
  const std::pair<std::string, std::string> files[] = {
      {"BZh91AY&SY", "byte 0: the file is compressed with bzip2; run bunzip2 and give the mesh"},
      {"\xfd\x37zXZ\0\0"s, "byte 0: the file is compressed with xz; run unxz and give the mesh"},
      {"<html>no such model</html>",
       "byte 0: the file is a web page; it stands for the mesh; fetch the mesh itself"},
      {"ISO-10303-21;\n",
       "byte 0: the file is a STEP file; it holds exact shapes; mesh them in a CAD program and "
       "export "
       "an STL or a PLY"},
      {"", "byte 0: the file is empty; copy or export it again"}};
  for (const auto& [bytes, message] : files)
    for (const std::string extension : {"", ".ply", ".stl", ".obj", ".off", ".txt"}) {
      const Reading reading = read_bytes(bytes, extension);
      EXPECT_EQ(reading.code, ErrorCode::kBadInput);
      EXPECT_EQ(reading.error, message) << extension;
    }
}

// So that a build ends before it takes any space.
TEST(ForeignFormat, IsRefusedByTheEstimateOfItsSize) {
  for (const std::string& bytes : {"BZh91AY&SY"s, ""s, "\xfe\xff\0p"s}) {
    const TemporaryFile file(bytes, ".ply");
    const auto size = MeshSize::estimate(file.path());
    ASSERT_FALSE(size);
    EXPECT_EQ(size.error().code, ErrorCode::kBadInput);
  }
}

}  // namespace
}  // namespace planetree::octree
