#include "tests/fuzz/mesh_mutator.h"

#include <algorithm>
#include <cstring>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

namespace planetree {
namespace {

constexpr std::string_view kEndHeader = "end_header\n";
constexpr std::size_t kStlHead = 84, kStlTriangle = 50;
constexpr std::string_view kBinaryChunk("BIN\0", 4);
constexpr std::size_t kGlbHead = 20, kChunkHead = 8;

std::size_t ply_text(std::string_view mesh) {
  const std::size_t end = mesh.find(kEndHeader);
  const bool is_ascii = mesh.find("format ascii") < end;
  return end == mesh.npos || is_ascii ? mesh.size() : end + kEndHeader.size();
}

std::size_t off_text(std::string_view mesh) {
  const std::size_t end = mesh.find("BINARY\n");
  return end == mesh.npos ? mesh.size() : end + 7;
}

std::size_t obj_text(std::string_view mesh) { return mesh.size(); }

std::size_t stl_text(std::string_view mesh) {
  return mesh.find("facet") < 200 || mesh.size() < kStlHead ? mesh.size() : 0;
}

bool is_glb(std::string_view mesh) { return mesh.starts_with("glTF") && mesh.size() >= kGlbHead; }

std::size_t gltf_text(std::string_view mesh) {
  const std::size_t end = mesh.find(kBinaryChunk);
  return is_glb(mesh) && end != mesh.npos && end >= kGlbHead + 4 ? end - 4 : mesh.size();
}

// A binary body may have become too short for the counts.
void repair_ply(std::string& mesh, Choices& choices) {
  if (ply_text(mesh) == mesh.size() || !choices.one_in(2)) return;
  for (std::size_t bytes = choices.below(64); bytes > 0; --bytes)
    mesh.push_back(choices.one_in(2) ? '\0' : static_cast<char>(choices.next()));
}

// The counts become those of the lines that follow, as vertices and faces.
void repair_off(std::string& mesh, Choices& choices) {
  const std::size_t start = mesh.find('\n');
  if (start == mesh.npos || off_text(mesh) != mesh.size() || choices.one_in(2)) return;
  const std::size_t end = mesh.find('\n', start + 1);
  if (end == mesh.npos) return;
  const auto lines = static_cast<std::size_t>(
      std::count(mesh.begin() + static_cast<std::ptrdiff_t>(end + 1), mesh.end(), '\n'));
  const std::size_t vertices = choices.below(lines + 1);
  mesh.replace(start + 1, end - start - 1,
               std::to_string(vertices) + " " + std::to_string(lines - vertices) + " 0");
}

void repair_obj(std::string&, Choices&) {}

// Binary STL is told by its length.
void repair_stl(std::string& mesh, Choices& choices) {
  if (stl_text(mesh) != 0 || choices.one_in(8)) return;
  const auto count = static_cast<std::uint32_t>((mesh.size() - kStlHead) / kStlTriangle);
  std::memcpy(mesh.data() + kStlHead - sizeof count, &count, sizeof count);
  mesh.resize(kStlHead + kStlTriangle * count);
}

constexpr std::string_view kPlyWords[] = {"element vertex",
                                          "element face",
                                          "element edge",
                                          "element tristrips",
                                          "property",
                                          "list",
                                          "char",
                                          "uchar",
                                          "short",
                                          "ushort",
                                          "int",
                                          "uint",
                                          "float",
                                          "double",
                                          "int8",
                                          "uint8",
                                          "int16",
                                          "uint16",
                                          "int32",
                                          "uint32",
                                          "float32",
                                          "float64",
                                          "x",
                                          "y",
                                          "z",
                                          "vertex_indices",
                                          "vertex_index",
                                          "nx",
                                          "red",
                                          "property list uchar int vertex_indices",
                                          "property float x",
                                          "property list int int vertex_indices",
                                          "property double z",
                                          "comment",
                                          "obj_info",
                                          "format ascii 1.0",
                                          "format binary_little_endian 1.0",
                                          "format binary_big_endian 1.0",
                                          "0",
                                          "1",
                                          "3",
                                          "-1",
                                          "255",
                                          "4294967295",
                                          "1e39",
                                          "nan",
                                          "-0.0"};
constexpr std::string_view kOffWords[] = {"OFF",        "COFF",
                                          "NOFF",       "STOFF",
                                          "CNOFF",      "4OFF",
                                          "nOFF",       "OFF BINARY",
                                          "#",          "0",
                                          "1",          "2",
                                          "3",          "4",
                                          "-1",         "1e39",
                                          "inf",        "nan",
                                          "-0",         "0.5",
                                          "4294967296", "18446744073709551616"};
constexpr std::string_view kObjWords[] = {"v",
                                          "vn",
                                          "vt",
                                          "vp",
                                          "f",
                                          "l",
                                          "p",
                                          "o",
                                          "g",
                                          "s off",
                                          "usemtl m",
                                          "mtllib m",
                                          "#",
                                          "\\",
                                          "\\\n",
                                          "1",
                                          "2",
                                          "3",
                                          "-1",
                                          "-2",
                                          "0",
                                          "1/1/1",
                                          "2//3",
                                          "3/2",
                                          "-1/-1",
                                          "1e39",
                                          "inf",
                                          "nan",
                                          "-0.0",
                                          "4294967297",
                                          "9223372036854775808",
                                          "f 1 2 3",
                                          "f -1 -2 -3",
                                          "v 1 2 3 0.5"};
constexpr std::string_view kStlWords[] = {
    "solid",  "facet",   "facet normal", "normal",   "outer loop", "outer", "loop",
    "vertex", "endloop", "endfacet",     "endsolid", "0",          "1",     "-1",
    "1e39",   "nan",     "inf",          "-0.0",     "0.5e-45"};

constexpr std::string_view kGltfWords[] = {"\"accessors\": [",
                                           "\"bufferViews\": [",
                                           "\"nodes\": [",
                                           "\"children\": [",
                                           "\"mesh\":",
                                           "\"mode\":",
                                           "\"indices\":",
                                           "\"sparse\": {",
                                           "\"byteOffset\":",
                                           "\"byteStride\":",
                                           "\"count\":",
                                           "\"componentType\":",
                                           "\"normalized\": true,",
                                           "\"scale\": [ -1, 2, 1e-300 ],",
                                           "\"rotation\": [ 0, 0, 0, 0 ],",
                                           "\"SCALAR\",",
                                           "\"VEC3\",",
                                           "5120,",
                                           "5121,",
                                           "5122,",
                                           "5123,",
                                           "5125,",
                                           "5126,",
                                           "{",
                                           "},",
                                           "[",
                                           "],",
                                           "0,",
                                           "1,",
                                           "3",
                                           "4096,",
                                           "-1,",
                                           "1e308,",
                                           "18446744073709551615,",
                                           "\"\\u0000\","};

bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// The parts of a text between separators, as [begin, end).
template <class Separates>
std::vector<std::pair<std::size_t, std::size_t>> split(std::string_view text, Separates is_apart) {
  std::vector<std::pair<std::size_t, std::size_t>> parts;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = at;
    while (at < text.size() && !is_apart(text[at])) ++at;
    if (at > begin) parts.emplace_back(begin, at);
    ++at;
  }
  return parts;
}

void change_word(std::string& text, const MeshGrammar& grammar, Choices& choices) {
  const auto words = split(text, [](char c) { return is_blank(c) || c == '\n'; });
  if (words.empty()) return;
  const auto [begin, end] = choices.of(words);
  switch (choices.below(3)) {
    case 0:
      text.replace(begin, end - begin, choices.of(grammar.words));
      break;
    case 1:
      text.insert(begin, std::string(choices.of(grammar.words)) + ' ');
      break;
    default: {  // the next number, or the one before
      char& last = text[end - 1];
      if ('0' < last && last < '9') last = static_cast<char>(last + (choices.one_in(2) ? 1 : -1));
    }
  }
}

// Repeats, removes, or exchanges lines.
void change_lines(std::string& text, Choices& choices) {
  const auto lines = split(text, [](char c) { return c == '\n'; });
  if (lines.size() < 2) return;
  const auto [begin, end] = choices.of(lines);
  const auto [from, to] = choices.of(lines);
  const std::string line = text.substr(from, to - from);
  switch (choices.below(3)) {
    case 0:
      text.insert(begin, line + '\n');
      break;
    case 1:
      text.erase(begin, std::min(end + 1, text.size()) - begin);
      break;
    default:
      text.replace(begin, end - begin, line);
  }
}

void change_binary(std::string& bytes, Choices& choices) {
  if (bytes.empty()) return;
  const std::size_t width = std::min(bytes.size(), std::size_t{1} << choices.below(4));
  const std::size_t at = choices.below(bytes.size() - width + 1);
  change_value(std::as_writable_bytes(std::span(bytes)).subspan(at, width), choices);
}

// The lengths of a GLB and of its chunks become those of what is there.
void repair_gltf(std::string& mesh, Choices& choices) {
  if (!is_glb(mesh) || choices.one_in(8)) return;
  const auto put = [&mesh](std::size_t at, std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    std::memcpy(mesh.data() + at, &number, sizeof number);
  };
  const std::size_t text_end = gltf_text(mesh);
  put(4, 2);
  put(8, mesh.size());
  put(12, text_end - kGlbHead);
  mesh.replace(16, 4, "JSON");
  if (text_end + kChunkHead <= mesh.size()) put(text_end, mesh.size() - text_end - kChunkHead);
}

}  // namespace

const MeshGrammar kPlyGrammar = {kPlyWords, ply_text, repair_ply};
const MeshGrammar kOffGrammar = {kOffWords, off_text, repair_off};
const MeshGrammar kObjGrammar = {kObjWords, obj_text, repair_obj};
const MeshGrammar kStlGrammar = {kStlWords, stl_text, repair_stl};
const MeshGrammar kGltfGrammar = {kGltfWords, gltf_text, repair_gltf};

std::size_t mutate_mesh(const MeshGrammar& grammar, std::uint8_t* data, std::size_t size,
                        std::size_t max_size, unsigned seed) {
  if (seed % 3 == 0) return LLVMFuzzerMutate(data, size, max_size);
  Choices choices(seed);
  std::string mesh(reinterpret_cast<const char*>(data), size);
  for (std::size_t changes = 1 + choices.below(4); changes > 0; --changes) {
    const std::size_t text_bytes = grammar.text_bytes(mesh);
    std::string text = mesh.substr(0, text_bytes), binary = mesh.substr(text_bytes);
    if (text.empty() || (!binary.empty() && choices.one_in(2)))
      change_binary(binary, choices);
    else if (choices.one_in(3))
      change_lines(text, choices);
    else
      change_word(text, grammar, choices);
    mesh = text + binary;
  }
  grammar.repair(mesh, choices);
  if (mesh.size() > max_size) return LLVMFuzzerMutate(data, size, max_size);
  std::copy(mesh.begin(), mesh.end(), data);
  return mesh.size();
}

}  // namespace planetree
