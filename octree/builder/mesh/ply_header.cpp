#include "octree/builder/mesh/ply_header.h"

#include <algorithm>
#include <cinttypes>
#include <optional>
#include <utility>

namespace planetree::octree {

namespace {

/// The type that a header calls `name`, in any case: "uchar", "uint8" or "uint8_t". "long" has 64
/// bits.
std::optional<ScalarType> type_named(std::string_view name) noexcept {
  static constexpr std::pair<std::string_view, ScalarType> kNames[] = {
      {"char", ScalarType::kInt8},      {"int8", ScalarType::kInt8},
      {"uchar", ScalarType::kUint8},    {"uint8", ScalarType::kUint8},
      {"short", ScalarType::kInt16},    {"int16", ScalarType::kInt16},
      {"ushort", ScalarType::kUint16},  {"uint16", ScalarType::kUint16},
      {"int", ScalarType::kInt32},      {"int32", ScalarType::kInt32},
      {"uint", ScalarType::kUint32},    {"uint32", ScalarType::kUint32},
      {"long", ScalarType::kInt64},     {"int64", ScalarType::kInt64},
      {"ulong", ScalarType::kUint64},   {"uint64", ScalarType::kUint64},
      {"longlong", ScalarType::kInt64}, {"ulonglong", ScalarType::kUint64},
      {"float", ScalarType::kFloat32},  {"float32", ScalarType::kFloat32},
      {"double", ScalarType::kFloat64}, {"float64", ScalarType::kFloat64}};
  if (name.ends_with("_t")) name.remove_suffix(2);
  for (const auto& [known, type] : kNames)
    if (is_same_word(name, known)) return type;
  return std::nullopt;
}

/// Whether a list is called "vertex_indices", in one of its spellings.
bool names_indices(std::string_view name) {
  std::string letters;
  for (const char c : name)
    if (c != '_') letters += c;
  return is_same_word(letters, "vertexindex") || is_same_word(letters, "vertexindices") ||
         is_same_word(letters, "vertexindexes");
}

Error header_error(const TextPosition& position, const std::string& cause) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, position.offset,
                    "line %" PRIu64 ": %s; export the mesh again", position.line, cause.c_str());
}

/// Parses a header line by line.
class HeaderParser {
 public:
  explicit HeaderParser(std::string_view file)
      : lines_(file, text_begin(file), line_end_of(file)) {}

  Result<PlyHeader> parse() {
    lines_.next();  // "ply"
    while (lines_.next()) {
      std::string_view rest = lines_.line();
      const std::string_view keyword = take_word(rest);
      if (is_same_word(keyword, "end_header")) return finish();
      if (Result<void> read = statement(keyword, rest); !read) return read.error();
    }
    return header_error(lines_.after(), "the file ends before 'end_header'");
  }

 private:
  /// A binary body begins right behind the last header line, whatever its first byte is. So the
  /// first line tells what ends a line. Some old writers end lines with '\r' alone.
  static LineEnd line_end_of(std::string_view file) {
    const std::size_t end = file.find_first_of("\r\n");
    const bool lone = end != std::string_view::npos && file[end] == '\r' &&
                      (end + 1 == file.size() || file[end + 1] != '\n');
    return lone ? LineEnd::kCarriageReturn : LineEnd::kNewline;
  }

  [[nodiscard]] Error error(const std::string& cause) const {
    return header_error(lines_.position(), cause);
  }

  Result<void> statement(std::string_view keyword, std::string_view rest) {
    if (keyword.empty() || is_same_word(keyword, "comment") || is_same_word(keyword, "obj_info"))
      return {};
    if (is_same_word(keyword, "format")) return format(rest);
    if (is_same_word(keyword, "element")) return element(rest);
    if (is_same_word(keyword, "property")) return property(rest);
    return error("'" + printable(keyword) + "' is no statement of a PLY header");
  }

  Result<void> format(std::string_view rest) {
    static constexpr std::pair<std::string_view, PlyEncoding> kNames[] = {
        {"ascii", PlyEncoding::kAscii},
        {"binary_little_endian", PlyEncoding::kBinaryLittleEndian},
        {"binary_big_endian", PlyEncoding::kBinaryBigEndian}};
    const std::string_view name = take_word(rest);
    const std::string_view version = take_word(rest);
    const auto* const known =
        std::find_if(std::begin(kNames), std::end(kNames),
                     [&](const auto& entry) { return is_same_word(name, entry.first); });
    double number = 1;  // there is no other version; some writers leave it out
    if (known == std::end(kNames) || (!version.empty() && !parse_real(version, number)) ||
        number != 1) {
      return error("format '" + printable(name) + " " + printable(version) + "' is unknown");
    }
    if (has_format_) return error("a second format");
    header_.encoding = known->second;
    has_format_ = true;
    return {};
  }

  Result<void> element(std::string_view rest) {
    PlyElement element;
    element.name = take_word(rest);
    std::string_view count = take_word(rest);
    std::int64_t value = 0;
    const std::string shown = printable(count);
    if (element.name.empty() || !take_integer(count, value) || !count.empty() || value < 0) {
      return error("'" + shown + "' is no count of an element");
    }
    element.count = static_cast<std::uint64_t>(value);
    for (const PlyElement& earlier : header_.elements) {
      if (earlier.name == element.name) {
        return error("a second element '" + printable(element.name) + "'");
      }
    }
    header_.elements.push_back(std::move(element));
    return {};
  }

  Result<void> property(std::string_view rest) {
    if (header_.elements.empty()) return error("a property in front of all elements");
    PlyProperty property;
    std::string_view word = take_word(rest);
    if (is_same_word(word, "list")) {
      property.is_list = true;
      const std::optional<ScalarType> count_type = type_named(take_word(rest));
      if (!count_type || !is_integer(*count_type)) {
        return error("a list whose length is of no integer type");
      }
      property.count_type = *count_type;
      word = take_word(rest);
    }
    const std::optional<ScalarType> type = type_named(word);
    if (!type) return error("type '" + printable(word) + "' is unknown");
    property.type = *type;
    property.name = take_word(rest);
    if (property.name.empty()) return error("a property without a name");
    header_.elements.back().properties.push_back(std::move(property));
    return {};
  }

  Result<PlyHeader> finish() {
    if (!has_format_) return error("the header names no format");
    header_.body = lines_.after();
    if (Result<void> found = find_vertices(); !found) return found.error();
    if (Result<void> found = find_faces(); !found) return found.error();
    return std::move(header_);
  }

  std::optional<std::size_t> find_element(std::string_view name) const {
    for (std::size_t i = 0; i < header_.elements.size(); ++i) {
      if (header_.elements[i].name == name) return i;
    }
    return std::nullopt;
  }

  Result<void> find_vertices() {
    const std::optional<std::size_t> found = find_element("vertex");
    if (!found) return error("the header has no element 'vertex'");
    header_.vertex_element = *found;
    static constexpr std::string_view kAxes[] = {"x", "y", "z"};
    const std::vector<PlyProperty>& properties = header_.vertices().properties;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::size_t times = 0;
      for (std::size_t i = 0; i < properties.size(); ++i) {
        if (properties[i].name != kAxes[axis] || properties[i].is_list) continue;
        header_.coordinates[axis] = i;
        ++times;
      }
      if (times != 1) {
        return error("the vertices have " + std::to_string(times) + " numbers '" +
                     std::string(kAxes[axis]) + "', not one");
      }
    }
    return {};
  }

  Result<void> find_faces() {
    const std::optional<std::size_t> faces = find_element("face"),
                                     strips = find_element("tristrips");
    const bool has_faces = faces && header_.elements[*faces].count > 0;
    const bool has_strips = strips && header_.elements[*strips].count > 0;
    // They may be the same surface twice, or two parts of it.
    if (has_faces && has_strips) return error("both faces and triangle strips: write one of them");
    if (!faces && !strips) return error("no triangle: the header has no element 'face'");
    header_.has_strips = has_strips || !faces;
    header_.face_element = header_.has_strips ? *strips : *faces;
    std::size_t times = 0;
    const std::vector<PlyProperty>& properties = header_.faces().properties;
    for (std::size_t i = 0; i < properties.size(); ++i) {
      const PlyProperty& property = properties[i];
      if (!names_indices(property.name)) continue;
      if (!property.is_list || !is_integer(property.type)) {
        return error("'" + property.name + "' is not a list of integers");
      }
      header_.index_list = i;
      ++times;
    }
    if (times == 1) return {};
    return error("the faces have " + std::to_string(times) +
                 " lists 'vertex_indices' or 'vertex_index', not one");
  }

  LineScanner lines_;
  PlyHeader header_;
  bool has_format_ = false;
};

}  // namespace

bool PlyElement::has_list() const noexcept {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.is_list; });
}

std::uint64_t PlyElement::offset_of(std::size_t index) const noexcept {
  std::uint64_t offset = 0;
  for (std::size_t i = 0; i < index; ++i) offset += size_bytes(properties[i].type);
  return offset;
}

std::uint64_t PlyElement::min_record_bytes() const noexcept {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : properties) {
    bytes += size_bytes(property.is_list ? property.count_type : property.type);
  }
  return bytes;
}

bool PlyHeader::float32() const {
  return fits_float32(coordinate_type(0)) && fits_float32(coordinate_type(1)) &&
         fits_float32(coordinate_type(2));
}

void PlyHeader::widen_text() {
  if (encoding != PlyEncoding::kAscii) return;
  for (const std::size_t i : coordinates)
    elements[vertex_element].properties[i].type = ScalarType::kFloat64;
}

bool is_ply(std::string_view file) noexcept {
  file.remove_prefix(text_begin(file).offset);
  if (!is_same_word(file.substr(0, 3), "ply") || file.size() < 4) return false;
  return file[3] == '\n' || file[3] == '\r' || file[3] == ' ' || file[3] == '\t';
}

Result<PlyHeader> parse_ply_header(std::string_view file) { return HeaderParser(file).parse(); }

}  // namespace planetree::octree
