#include "octree/builder/mesh/off_reader.h"

#include <bit>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "octree/builder/mesh/header_prefix.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/ply_reader.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "octree/builder/mesh/stream/scalar_type.h"

namespace planetree::octree {

namespace {

/// Letters in front of "OFF", which tell what follows x, y and z in a vertex.
struct OffPrefix {
  std::string_view letters;
  std::size_t more_numbers;
  bool supported;
};

constexpr OffPrefix kPrefixes[] = {
    {"ST", 2, true}, {"C", 4, true}, {"N", 3, true}, {"4", 0, false}, {"n", 0, false}};

struct OffKeyword {
  std::size_t more_numbers = 0;  ///< behind x, y and z in a binary vertex
  bool has_colours = false;      ///< of three or four numbers in an ascii vertex
  bool supported = true;
};

/// Removes the keyword from the front of a file's first word. Geomview writes its letters in one
/// order, others in any order, each once.
std::optional<OffKeyword> take_keyword(std::string_view& word) noexcept {
  std::string_view rest = word;
  OffKeyword keyword;
  if (is_same_word(word, "off")) {
    word = {};
    return keyword;
  }
  for (std::size_t i = 0; i < std::size(kPrefixes) && !rest.starts_with("OFF"); ++i) {
    for (const OffPrefix& prefix : kPrefixes) {
      if (!rest.starts_with(prefix.letters)) continue;
      rest.remove_prefix(prefix.letters.size());
      keyword.more_numbers += prefix.more_numbers;
      keyword.supported &= prefix.supported;
      keyword.has_colours |= prefix.letters == "C";
      break;
    }
  }
  if (!rest.starts_with("OFF")) return std::nullopt;
  rest.remove_prefix(3);
  // Well-known collections have files that go on without a blank: "OFF8 6 12".
  if (!rest.empty() && (rest.front() < '0' || rest.front() > '9')) return std::nullopt;
  word = rest;
  return keyword;
}

/// The records of a file as a PLY header would declare them. Numbers of an ascii file have no
/// declared precision, so that the widest is taken.
PlyHeader records_of(PlyEncoding encoding, std::size_t more_numbers) {
  const bool is_ascii = encoding == PlyEncoding::kAscii;
  const ScalarType real = is_ascii ? ScalarType::kFloat64 : ScalarType::kFloat32;
  PlyHeader header;
  header.encoding = encoding;
  header.has_loose_lines = is_ascii;
  header.elements = {{"vertex", 0, {}}, {"face", 0, {}}};
  for (const char* name : {"x", "y", "z"}) header.elements[0].properties.push_back({name, real});
  header.elements[1].properties = {{"corners", ScalarType::kInt32, true, ScalarType::kInt32}};
  if (!is_ascii) {
    header.elements[0].properties.resize(3 + more_numbers, {"more", real});
    header.elements[1].properties.push_back({"colour", real, true, ScalarType::kInt32});
  }
  header.vertex_element = 0;
  header.face_element = 1;
  header.coordinates = {0, 1, 2};
  return header;
}

/// Parses the header up to where the vertices begin.
class OffHeader {
 public:
  explicit OffHeader(std::string_view file)
      : file_(file), lines_(file, text_begin(file), LineEnd::kAny, LineComment::kHash) {}

  Result<PlyHeader> parse() {
    if (!lines_.next_filled()) return cut_off();
    std::string_view rest = lines_.line();
    std::string_view word = take_word(rest);
    const std::string shown = printable(word);
    const std::optional<OffKeyword> keyword = take_keyword(word);
    if (!keyword) return counts(lines_.line());
    behind_vertex_ = keyword->more_numbers;
    if (keyword->has_colours) behind_vertex_.reset();
    if (!keyword->supported) {
      return error("'" + shown + "' has vertices of other than three dimensions: write plain OFF");
    }
    if (!word.empty()) return counts({word.data(), word.size() + rest.size()});
    std::string_view behind = rest;
    const std::string_view next = take_word(behind);
    if (next == "BINARY") return binary_counts(behind, keyword->more_numbers);
    if (!next.empty()) return counts(rest);
    if (!lines_.next_filled()) return cut_off();
    return counts(lines_.line());
  }

 private:
  /// Parses the counts of vertices, faces and edges. The last is often wrong or missing, if the
  /// others are on one line. Where each is on a line of its own, it is not. The vertices may follow
  /// on the same line.
  Result<PlyHeader> counts(std::string_view text) {
    PlyHeader header = records_of(PlyEncoding::kAscii, 0);
    header.numbers_behind_vertex = behind_vertex_;
    const TextPosition begin = lines_.position();
    std::string_view rest = text;
    for (std::size_t i = 0; i < kCounts; ++i) {
      skip_blanks(rest);
      const bool is_alone = rest.empty() && (i == 1 || is_over_lines_);
      if (rest.empty() && !is_alone) break;
      if (is_alone) {
        is_over_lines_ = true;
        if (!lines_.next_filled()) return no_counts(text, begin);
        rest = lines_.line();
      }
      std::string_view word = take_word(rest);
      std::int64_t count = 0;
      if (!take_integer(word, count) || !word.empty() || (i < 2 && count < 0))
        return no_counts(text, begin);
      if (i < 2) header.elements[i].count = static_cast<std::uint64_t>(count);
    }
    skip_blanks(rest);
    header.body = lines_.after();
    if (rest.empty()) return header;
    header.body = {static_cast<std::uint64_t>(rest.data() - file_.data()), lines_.position().line,
                   1};
    // At least a vertex follows, or the words are no counts.
    for (std::size_t i = 0; i < 3; ++i)
      if (is_over_lines_ || take_word(rest).empty()) return no_counts(text, begin);
    return header;
  }

  Result<PlyHeader> binary_counts(std::string_view behind, std::size_t more_numbers) {
    if (!take_word(behind).empty()) return error("text follows 'BINARY'");
    constexpr std::uint64_t kCountBytes = 4;
    constexpr bool kSwap = std::endian::native != std::endian::big;
    PlyHeader header = records_of(PlyEncoding::kBinaryBigEndian, more_numbers);
    TextPosition position = lines_.after();
    if (file_.size() - position.offset < 3 * kCountBytes) return cut_off();
    for (PlyElement& element : header.elements) {
      const auto* const at = reinterpret_cast<const std::byte*>(file_.data()) + position.offset;
      const auto count = load<std::int32_t>(at, kSwap);
      if (count < 0) return error_at(position, "a count of " + std::to_string(count));
      element.count = static_cast<std::uint64_t>(count);
      position.offset += kCountBytes;
    }
    position.offset += kCountBytes;  // the count of edges
    header.body = position;
    return header;
  }

  [[nodiscard]] static Error no_counts(std::string_view text, const TextPosition& begin) {
    return error_at(begin,
                    "'" + printable(text) + "' is not the numbers of vertices, faces and edges");
  }

  [[nodiscard]] Error cut_off() const {
    return error_at(lines_.after(), "the file ends in front of its counts");
  }

  [[nodiscard]] Error error(const std::string& cause) const {
    return error_at(lines_.position(), cause);
  }

  [[nodiscard]] static Error error_at(const TextPosition& position, const std::string& cause) {
    return make_error(ErrorCode::kBadInput, Error::kNowhere, position.offset,
                      "line %" PRIu64 ": %s; copy or export the OFF again", position.line,
                      cause.c_str());
  }

  static constexpr std::size_t kCounts = 3;

  std::string_view file_;
  LineScanner lines_;
  std::optional<std::size_t> behind_vertex_ = 0;  ///< numbers behind the coordinates of a vertex
  bool is_over_lines_ = false;                    ///< each count is on a line of its own
};

}  // namespace

bool is_off(std::string_view file) noexcept {
  LineScanner lines(file, text_begin(file), LineEnd::kAny, LineComment::kHash);
  if (!lines.next_filled()) return false;
  std::string_view rest = lines.line();
  std::string_view word = take_word(rest);
  return take_keyword(word).has_value();
}

Result<PlyHeader> parse_off_header(std::string_view file) { return OffHeader(file).parse(); }

Result<MeshSummary> read_off(const MeshFile& file, TriangleSink& sink, MeshScratch& scratch) {
  const Result<PlyHeader> header = parse_prefix(file, parse_off_header);
  if (!header) return header.error();
  return read_ply_body(file, *header, sink, scratch);
}

}  // namespace planetree::octree
