// Files of other formats are refused by name, whatever they are given as and are called.

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "tests/octree/builder/mesh/mesh_recorder.h"
#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/cli/captured_console.h"

namespace planetree::tools {
namespace {

using namespace std::string_literals;
using octree::TemporaryFile;

/// The front of a file, and words of the messages that name its format.
struct ForeignFile {
  std::string front;
  std::string as_mesh, as_points;
};

std::string behind(std::size_t bytes, const std::string& magic) {
  return std::string(bytes, ' ') + magic;
}

const std::vector<ForeignFile>& foreign_files() {
  static const std::vector<ForeignFile> all = {
      {"BZh91AY&SY", "bzip2", "bzip2"},
      {"\xfd\x37zXZ\0\0"s, "xz", "xz"},
      {"\x04\x22\x4d\x18\x64", "LZ4", "LZ4"},
      {"7z\xbc\xaf\x27\x1c", "7z archive", "7z archive"},
      {"Rar!\x1a\x07\x01", "RAR archive", "RAR archive"},
      {"PK\3\4....3D/3dmodel.model", "3MF file", "ZIP archive"},
      {"PK\3\4....scene.usdc", "USD package", "ZIP archive"},
      {behind(257, "ustar\0"s), "tar archive", "tar archive"},
      {"Kaydara FBX Binary  \0"s, "FBX file", "FBX model"},
      {"; FBX 7.3.0 project file\n", "FBX file in text form", "FBX file in text form"},
      {"# vtk DataFile Version 3.0\n", "VTK file", "VTK file"},
      {"<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">", "VTK file", "XML"},
      {"<?xml version=\"1.0\"?><COLLADA xmlns=", "Collada file", "XML"},
      {"<X3D profile=\"Immersive\">", "X3D file", "X3D file"},
      {"<amf unit=\"millimeter\">", "AMF file", "AMF file"},
      {"<svg xmlns=", "SVG drawing", "SVG drawing"},
      {"<!DOCTYPE html><title>404", "web page", "HTML"},
      {"#VRML V2.0 utf8\n", "VRML file", "VRML file"},
      {"#Inventor V2.1 ascii\n", "Open Inventor file", "Open Inventor file"},
      {"PXR-USDC\0\0"s, "USD file", "USD file"},
      {"#usda 1.0\n", "USD file in text form", "USD file in text form"},
      {"BLENDER-v306", "Blender file", "Blender file"},
      {"DRACO\2\2", "Draco file", "Draco file"},
      {"OCTM\5\0\0\0"s, "OpenCTM file", "OpenCTM file"},
      {"MeshVersionFormatted 1\n", "Medit mesh", "Medit mesh"},
      {"$MeshFormat\n4.1 0 8\n", "Gmsh file", "Gmsh file"},
      {"3D Geometry File Format        5", "Rhino file", "Rhino file"},
      {"ISO-10303-21;\nHEADER;", "STEP file", "STEP file"},
      {behind(72, "S      1\n"), "IGES file", "IGES file"},
      {"**ABCDEFGHIJKLMNOPQRSTUVWXYZabc", "Parasolid file", "Parasolid file"},
      {behind(128, "DICM"), "DICOM file", "DICOM file"},
      {behind(344, "n+1\0"s), "NIfTI file", "NIfTI file"},
      {"NRRD0005\ntype: short\n", "NRRD file", "NRRD file"},
      {"ASTM-E57\1\0\0\0"s, "E57 file", "E57 point cloud"},
      {"# .PCD v0.7 - Point Cloud Data file format\n", "PCD file", "PCD point cloud"},
      {"\x89HDF\r\n\x1a\n", "HDF5 file", "HDF5 file"},
      {"\x89PNG\r\n\x1a\n", "PNG image", "PNG picture"},
      {"\xff\xd8\xff\xe0", "JPEG image", "JPEG image"},
      {"%PDF-1.7\n", "PDF document", "PDF document"},
      {"\x89PTREE\r\n", ".ptree file", ".ptree file"},
      {"version https://git-lfs.github.com/spec/v1\noid", "Git LFS", "Git LFS"},
      {"{ \"vertices\": [[0, 0, 0]] }", "JSON file", "JSON"},
      {"\xff\xfep\0l\0y\0"s, "UTF-16", "UTF-16"},
      {"LASF\0\0\0\0"s, "LAS or LAZ file", "LAS"},
      {"", "empty", "no point"},
  };
  return all;
}

/// Expects that a run fails, says one line that has the words, and writes nothing.
void expect_named(const Outcome& outcome, const std::string& words) {
  EXPECT_EQ(outcome.status, 1) << words;
  EXPECT_EQ(outcome.output, "") << words;
  EXPECT_NE(outcome.errors.find(words), std::string::npos) << outcome.errors;
}

TEST(ForeignFiles, AreNamedByBuild) {
  const storage::TemporaryDirectory folder;
  for (const ForeignFile& foreign : foreign_files())
    for (const std::string extension : {".ply", ".obj", ".gltf", ".bin"}) {
      const TemporaryFile file(foreign.front, extension);
      const std::string output = folder / "out.ptree";
      if (extension == ".gltf" && foreign.front.starts_with('{')) continue;
      expect_named(run({"build", file.path().c_str(), "-o", output.c_str()}), foreign.as_mesh);
    }
  EXPECT_EQ(folder.names(), std::vector<std::string>());
}

TEST(ForeignFiles, AreNamedByWhatReadsPoints) {
  const storage::TemporaryDirectory folder;
  const std::string mesh = folder / "mesh.ply", model = folder / "mesh.ptree";
  ASSERT_EQ(run({"generate", mesh.c_str(), "--triangles", "100"}).status, 0);
  ASSERT_EQ(run({"build", mesh.c_str(), "-o", model.c_str()}).status, 0);
  const std::string output = folder / "out.ply";
  for (const ForeignFile& foreign : foreign_files())
    for (const std::string extension : {".csv", ".xyz", ".bin"}) {
      const TemporaryFile file(foreign.front, extension);
      expect_named(run({"query", model.c_str(), file.path().c_str()}), foreign.as_points);
      expect_named(run({"thickness", model.c_str(), file.path().c_str()}), foreign.as_points);
    }
  EXPECT_EQ(folder.names(), (std::vector<std::string>{"mesh.ply", "mesh.ptree"}));
}

}  // namespace
}  // namespace planetree::tools
