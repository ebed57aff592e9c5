#include "tools/points/foreign_format.h"

#include <algorithm>
#include <string>

#include "octree/builder/mesh/foreign_format.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "tools/points/sample_lines.h"
#include "tools/points/text_layout.h"

namespace planetree::tools {
namespace {

using namespace std::string_view_literals;

constexpr const char* kConvert = "";  // to a format that is read
constexpr const char* kUnpack = "unpack it first";
constexpr const char* kRecode = "save it as UTF-8";

/// What a file begins with, and how a message says that.
struct Signature {
  std::string_view bytes;
  const char* name;
  const char* remedy;  // kConvert: another format
};

constexpr Signature kSignatures[] = {
    {"ASTM-E57"sv, "an E57 point cloud", kConvert},
    {"# .PCD"sv, "a PCD point cloud", kConvert},
    {"#.PCD"sv, "a PCD point cloud", kConvert},
    {"glTF"sv, "a binary glTF (GLB) model", kConvert},
    {"# vtk DataFile"sv, "a VTK file", kConvert},
    {"Kaydara FBX"sv, "an FBX model", kConvert},
    {"DRACO"sv, "a Draco file", kConvert},
    {"<?xml"sv, "XML", kConvert},
    {"<VTKFile"sv, "a VTK file", kConvert},
    {"<!DOCTYPE"sv, "HTML", kConvert},
    {"{"sv, "JSON", kConvert},
    {"["sv, "JSON", kConvert},
    {"\x89HDF"sv, "an HDF5 file", kConvert},
    {"PAR1"sv, "a Parquet table", kConvert},
    {"\x89PTREE"sv, "a .ptree file", "give the list behind it"},
    {"\x89PNG"sv, "a PNG picture", kConvert},
    {"%PDF"sv, "a PDF document", kConvert},
    {"PK\3\4"sv, "a ZIP archive or a spreadsheet", "unpack it, or save the sheet as CSV"},
    {"\x1f\x8b"sv, "gzip", "unpack it by gzip -d"},
    {"\x28\xb5\x2f\xfd"sv, "zstd", "unpack it by zstd -d"},
    {"\xfd"
     "7zXZ"sv,
     "xz", "unpack it by xz -d"},
    {"BZh"sv, "bzip2", "unpack it by bzip2 -d"},
    {"7z\xbc\xaf"sv, "a 7z archive", kUnpack},
    {"Rar!"sv, "a RAR archive", kUnpack},
    {"\xff\xfe\0\0"sv, "UTF-32 text", kRecode},
    {"\0\0\xfe\xff"sv, "UTF-32 text", kRecode},
    {"\xff\xfe"sv, "UTF-16 text", kRecode},
    {"\xfe\xff"sv, "UTF-16 text", kRecode},
};

Error refusal(const RowShape& shape, const char* name, const char* remedy) {
  std::string convert = std::string("save its ") + shape.noun + "s as CSV";
  convert += shape.kind == RowKind::kPoint ? ", PLY, LAS, .npy or .f64" : ", .npy or .f64";
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "this is %s, not a list of %ss; %s", name, shape.noun,
                    *remedy == 0 ? convert.c_str() : remedy);
}

bool contains_word(const std::vector<SampleLines::Line>& lines, std::string_view wanted) {
  return std::any_of(lines.begin(), lines.end(), [wanted](const SampleLines::Line& line) {
    std::string_view rest = line.text;
    return octree::is_same_word(octree::take_word(rest), wanted);
  });
}

/// Whether the lines are an OBJ's: v, and a keyword other than v.
bool is_obj_mesh(const std::vector<SampleLines::Line>& lines) {
  constexpr std::string_view kKeywords[] = {"f", "l",  "p",  "o",      "g",
                                            "s", "vn", "vt", "mtllib", "usemtl"};
  if (!contains_word(lines, "v")) return false;
  return std::any_of(std::begin(kKeywords), std::end(kKeywords),
                     [&lines](std::string_view keyword) { return contains_word(lines, keyword); });
}

/// Whether two counts precede the rows, as the size of a PTX grid does.
bool is_ptx(const std::vector<SampleLines::Line>& lines) {
  return lines.size() > 2 && is_count(lines[0].text) && is_count(lines[1].text) &&
         count_fields(lines[2].text, Separator::kBlank).numbers == 3;
}

const char* text_format(std::string_view front) {
  const SampleLines sample(front);
  const auto& lines = sample.lines();
  if (lines.empty()) return nullptr;
  std::string_view rest = lines[0].text;
  const std::string_view first = octree::take_word(rest);
  if (octree::is_same_word(first, "solid") && contains_word(lines, "facet")) return "an STL mesh";
  for (const std::string_view keyword : {"off"sv, "coff"sv, "noff"sv, "cnoff"sv, "stoff"sv})
    if (octree::is_same_word(first, keyword)) return "an OFF mesh";
  if (contains_word(lines, "fields") && contains_word(lines, "points")) return "a PCD point cloud";
  if (is_obj_mesh(lines)) return "an OBJ mesh";
  return is_ptx(lines) ? "a PTX scan" : nullptr;
}

/// Whether a file is as long as a binary STL with the count of facets in its front.
bool has_binary_stl_size(std::string_view front, std::uint64_t size_bytes) {
  constexpr std::size_t kHeaderBytes = 80, kFacetBytes = 50;
  if (front.size() < kHeaderBytes + 4) return false;
  std::uint64_t facets = 0;
  for (std::size_t i = 4; i-- > 0;)
    facets = facets << 8 | static_cast<unsigned char>(front[kHeaderBytes + i]);
  return size_bytes == kHeaderBytes + 4 + kFacetBytes * facets;
}

/// Whether no text has this byte.
constexpr bool is_binary(char c) {
  return static_cast<unsigned char>(c) == 0x7f ||
         (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\r' && c != '\t' &&
          c != '\f' && c != '\v');
}

/// Whether every second byte of a text is zero.
bool is_utf16(std::string_view front) {
  const auto zeros = [front](std::size_t first) {
    std::size_t count = 0;
    for (std::size_t i = first; i < front.size(); i += 2) count += front[i] == '\0' ? 1 : 0;
    return count;
  };
  const std::size_t even = zeros(0), odd = zeros(1), half = front.size() / 2;
  return front.size() >= 4 && ((even >= half && odd == 0) || (odd >= half && even == 0));
}

}  // namespace

std::optional<Error> find_foreign_format(std::string_view front,
                                         std::optional<std::uint64_t> size_bytes,
                                         const RowShape& shape) {
  if (size_bytes && has_binary_stl_size(front, *size_bytes))
    return refusal(shape, "a binary STL mesh", kConvert);
  const auto text = front.substr(octree::text_begin(front).offset);
  for (const Signature& signature : kSignatures)
    if (front.starts_with(signature.bytes) || text.starts_with(signature.bytes))
      return refusal(shape, signature.name, signature.remedy);
  if (is_utf16(front)) return refusal(shape, "UTF-16 text", kRecode);
  // What a mesh is not either. Zero bytes are told as such below, with their place.
  const auto known = octree::foreign_format(front);
  if (known && front.find_first_not_of('\0') != std::string_view::npos)
    return refusal(shape, std::string(known->name).c_str(), kConvert);
  const auto binary = std::find_if(front.begin(), front.end(), is_binary);
  if (binary != front.end())
    return make_error(
        ErrorCode::kBadInput, Error::kNowhere, static_cast<std::uint64_t>(binary - front.begin()),
        "this is binary data, not text; give CSV, PLY, LAS, .npy, or raw float64 in a file "
        "named .f64");
  if (const char* const name = text_format(front)) return refusal(shape, name, kConvert);
  return std::nullopt;
}

}  // namespace planetree::tools
