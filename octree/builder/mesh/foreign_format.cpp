#include "octree/builder/mesh/foreign_format.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "octree/builder/mesh/stream/mesh_text.h"

namespace planetree::octree {

namespace {

using namespace std::string_view_literals;

constexpr std::string_view kUnpack = "unpack it and give the mesh in it";
constexpr std::string_view kExport =
    "open it in the program it is from and export PLY, STL, OBJ, OFF or glTF";
constexpr std::string_view kPoints =
    "it holds points without triangles; reconstruct a surface and export it as a PLY";
constexpr std::string_view kVolume =
    "it holds a volume; extract a surface and export it as a PLY or an STL";
constexpr std::string_view kShape =
    "it holds exact shapes; mesh them in a CAD program and export an STL or a PLY";
constexpr std::string_view kFetch = "it stands for the mesh; fetch the mesh itself";

/// Bytes at one position that only one format has.
struct Signature {
  std::size_t offset;
  std::string_view bytes;
  ForeignFormat format;
};

// A mesh that is compressed by gzip or zstd is unpacked before its format is detected. These two
// name a content that is compressed again.
constexpr Signature kSignatures[] = {
    {0, "\x89PTREE\r\n"sv, {"a .ptree file", "it is built already; give the mesh it is of"}},
    {0, "\x1f\x8b"sv, {"compressed again with gzip", "unpack it until it is a mesh"}},
    {0, "\x28\xb5\x2f\xfd"sv, {"compressed again with zstd", "unpack it until it is a mesh"}},
    {0, "BZh"sv, {"compressed with bzip2", "run bunzip2 and give the mesh"}},
    {0, "\xfd\x37zXZ\0"sv, {"compressed with xz", "run unxz and give the mesh"}},
    {0, "\x04\x22\x4d\x18"sv, {"compressed with LZ4", "run unlz4 and give the mesh"}},
    {0, "7z\xbc\xaf\x27\x1c"sv, {"a 7z archive", kUnpack}},
    {0, "Rar!\x1a\x07"sv, {"a RAR archive", kUnpack}},
    {257, "ustar"sv, {"a tar archive", kUnpack}},
    {0, "Kaydara FBX Binary"sv, {"an FBX file", kExport}},
    {0, "; FBX"sv, {"an FBX file in text form", kExport}},
    {0,
     "# vtk DataFile"sv,
     {"a VTK file", "open it in ParaView and save its surface as PLY or STL"}},
    {128, "DICM"sv, {"a DICOM file", kVolume}},
    {344, "n+1\0"sv, {"a NIfTI file", kVolume}},
    {0, "NRRD0"sv, {"an NRRD file", kVolume}},
    {0, "LASF"sv, {"a LAS or LAZ file", kPoints}},
    {0, "ASTM-E57"sv, {"an E57 file", kPoints}},
    {0, "# .PCD"sv, {"a PCD file", kPoints}},
    {0, "ISO-10303-21"sv, {"a STEP file", kShape}},
    {0, "**ABCDEFGHIJKLMNOPQRSTUVWXYZ"sv, {"a Parasolid file", kShape}},
    {0, "PS\0\0"sv, {"a Parasolid file", kShape}},
    {0, "3D Geometry File Format"sv, {"a Rhino file", kShape}},
    {0, "PXR-USDC"sv, {"a USD file", kExport}},
    {0, "#usda"sv, {"a USD file in text form", kExport}},
    {0, "BLENDER"sv, {"a Blender file", kExport}},
    {0, "#VRML"sv, {"a VRML file", kExport}},
    {0, "#Inventor"sv, {"an Open Inventor file", kExport}},
    {0, "DRACO"sv, {"a Draco file", kExport}},
    {0, "OCTM"sv, {"an OpenCTM file", kExport}},
    {0, "MeshVersionFormatted"sv, {"a Medit mesh", kExport}},
    {0, "$MeshFormat"sv, {"a Gmsh file", kExport}},
    {0, "\x89HDF\r\n\x1a\n"sv, {"an HDF5 file", kExport}},
    {0, "\x93NUMPY"sv, {"a NumPy array", "write its triangles as a PLY"}},
    {0, "\x89PNG\r\n"sv, {"a PNG image", "give a mesh"}},
    {0, "\xff\xd8\xff"sv, {"a JPEG image", "give a mesh"}},
    {0, "%PDF-"sv, {"a PDF document", "give a mesh"}},
    {0,
     "version https://git-lfs"sv,
     {"a pointer of Git LFS", "it stands for the mesh: run git lfs pull"}},
    {0, "/annex/objects/"sv, {"a pointer of git-annex", kFetch}},
    {0, "\xff\xfe"sv, {"a text in UTF-16", "save it as UTF-8"}},
    {0, "\xfe\xff"sv, {"a text in UTF-16", "save it as UTF-8"}},
};

/// What a file is whose front, in any case, has a word; in the order in which they are looked for.
struct Mark {
  std::string_view lower;
  ForeignFormat format;
};

constexpr Mark kXmlMarks[] = {
    {"<!doctype html", {"a web page", kFetch}},
    {"<html", {"a web page", kFetch}},
    {"<vtkfile", {"a VTK file", "open it in ParaView and save its surface as PLY or STL"}},
    {"<collada", {"a Collada file", kExport}},
    {"<x3d", {"an X3D file", kExport}},
    {"<amf", {"an AMF file", kExport}},
    {"<model", {"the model of a 3MF file", kExport}},
    {"<svg", {"an SVG drawing", "give a mesh"}},
    {"<?xml", {"an XML file", kExport}},
};

constexpr Mark kZipMarks[] = {
    {"3d/", {"a 3MF file", kExport}},
    {"[content_types].xml", {"a 3MF file or another ZIP package", kExport}},
    {".usd", {"a USD package", kExport}},
    {"", {"a ZIP archive", kUnpack}},
};

/// Whether `text` has `lower` somewhere, whatever its case.
bool has_word(std::string_view text, std::string_view lower) {
  const auto same = [](char a, char b) {
    return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b;
  };
  return std::search(text.begin(), text.end(), lower.begin(), lower.end(), same) != text.end() ||
         lower.empty();
}

template <std::size_t kCount>
std::optional<ForeignFormat> marked(std::string_view text, const Mark (&marks)[kCount]) {
  for (const Mark& mark : marks)
    if (has_word(text, mark.lower)) return mark.format;
  return std::nullopt;
}

/// Whether every other byte of the front is 0 and none between them is: Latin text of 16 bits.
bool is_wide_text(std::string_view file) {
  constexpr std::size_t kBytes = 16;
  if (file.size() < kBytes) return false;
  for (const std::size_t zero : {std::size_t{0}, std::size_t{1}}) {
    bool is_wide = true;
    for (std::size_t i = 0; i < kBytes; ++i) is_wide &= (file[i] == '\0') == (i % 2 == zero);
    if (is_wide) return true;
  }
  return false;
}

/// An IGES file has cards of 80 characters, whose last eight are a letter and a number.
bool is_iges(std::string_view file) {
  return file.size() >= 80 && file.substr(72, 1) == "S" &&
         file.substr(73, 7).find_first_not_of(" 0") == 6 && file[79] == '1';
}

/// The text behind a byte order mark and white space.
std::string_view text_of(std::string_view file) {
  std::string_view text = file.substr(text_begin(file).offset);
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  return text;
}

bool is_json(std::string_view text) {
  if (!text.starts_with('{')) return false;
  text.remove_prefix(1);
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  return text.starts_with('"');
}

}  // namespace

std::optional<ForeignFormat> foreign_format(std::string_view file) noexcept {
  if (file.empty()) return ForeignFormat{"empty", "copy or export it again"};
  for (const Signature& known : kSignatures)
    if (file.size() >= known.offset && file.substr(known.offset).starts_with(known.bytes))
      return known.format;
  if (file.starts_with("PK\x03\x04")) return marked(file, kZipMarks);
  const std::string_view text = text_of(file);
  if (text.starts_with('<')) return marked(text, kXmlMarks);
  if (is_json(text)) return ForeignFormat{"a JSON file and no glTF", kExport};
  if (text.starts_with('{') && has_word(text.substr(0, 80), "off"))
    return ForeignFormat{"an object of Geomview in braces", "give the OFF in it alone"};
  if (is_wide_text(file)) return ForeignFormat{"a text in UTF-16", "save it as UTF-8"};
  if (is_iges(file)) return ForeignFormat{"an IGES file", kShape};
  if (file.size() >= 84 && file.find_first_not_of('\0') == std::string_view::npos)
    return ForeignFormat{"nothing but zero bytes so far", "copy or download it again"};
  return std::nullopt;
}

}  // namespace planetree::octree
