#include "octree/builder/mesh/ply_ascii.h"

#include <array>
#include <cinttypes>
#include <optional>
#include <string>

namespace planetree::octree {

namespace {

Error line_error(const TextPosition& position, const std::string& cause) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, position.offset,
                    "line %" PRIu64 ": %s; copy or export the mesh again", position.line,
                    cause.c_str());
}

/// The words of a line, read as the header declares them.
class Row {
 public:
  explicit Row(const MeshLines& lines) : rest_(lines.line()), position_(lines.position()) {}

  Result<std::string_view> word(const PlyProperty& property) {
    const std::string_view word = take_word(rest_);
    if (!word.empty()) return word;
    return error("the line ends in front of '" + printable(property.name) + "'");
  }

  Result<std::int64_t> integer(const PlyProperty& property) {
    const Result<std::string_view> word = this->word(property);
    if (!word) return word.error();
    std::string_view rest = *word;
    std::int64_t value = 0;
    if (take_integer(rest, value) && rest.empty()) return value;
    return error("'" + printable(*word) + "' in '" + printable(property.name) +
                 "' is not an integer");
  }

  /// Reads the length of a list, which the items follow.
  Result<std::int64_t> length(const PlyProperty& property) {
    const Result<std::int64_t> length = integer(property);
    if (length && *length < 0) {
      return error("list '" + printable(property.name) + "' has a negative length");
    }
    return length;
  }

  /// Reads a number in the precision that the header declares, whatever digits the line has.
  Result<double> real(const PlyProperty& property) {
    const Result<std::string_view> word = this->word(property);
    if (!word) return word.error();
    double value = 0;
    float narrow = 0;
    const bool is_narrow = fits_float32(property.type);
    if (is_narrow ? parse_real(*word, narrow) : parse_real(*word, value)) {
      return is_narrow ? static_cast<double>(narrow) : value;
    }
    return error("'" + printable(*word) + "' in '" + printable(property.name) +
                 "' is not a number");
  }

  Result<void> pass(const PlyProperty& property) {
    std::int64_t count = 1;
    if (property.is_list) {
      const Result<std::int64_t> length = this->length(property);
      if (!length) return length.error();
      count = *length;
    }
    for (std::int64_t i = 0; i < count; ++i) {
      if (Result<std::string_view> word = this->word(property); !word) return word.error();
    }
    return {};
  }

  Result<void> expect_end() {
    const std::string_view word = take_word(rest_);
    if (word.empty()) return {};
    return error("'" + printable(word) + "' follows the last declared value");
  }

  /// Refuses a number of further words other than `count`, which the first call sets.
  Result<void> expect_rest(std::optional<std::uint64_t>& count) {
    std::uint64_t left = 0;
    while (!take_word(rest_).empty()) ++left;
    if (!count) count = left;
    if (left == *count) return {};
    return error(
        "a vertex of more or fewer numbers than the first, so a count in the header may be wrong");
  }

 private:
  [[nodiscard]] Error error(const std::string& cause) const { return line_error(position_, cause); }

  std::string_view rest_;
  TextPosition position_;
};

}  // namespace

/// A face whose line was read.
class PlyAscii::Face {
 public:
  Face(std::uint64_t record, const std::vector<std::int64_t>& indices)
      : record_(record), indices_(indices) {}

  [[nodiscard]] std::uint64_t record() const { return record_; }
  [[nodiscard]] std::uint64_t size() const { return indices_.size(); }
  bool value_at(std::uint64_t k, std::int64_t& value) const {
    value = indices_[static_cast<std::size_t>(k)];
    return true;
  }
  [[nodiscard]] static std::int64_t vertices_before() { return 0; }
  [[nodiscard]] static Error failure() { return {}; }

 private:
  const std::uint64_t record_;
  const std::vector<std::int64_t>& indices_;
};

PlyAscii::PlyAscii(const MeshFile& file, const PlyHeader& header, FanEmitter& emitter,
                   MeshScratch& scratch)
    : file_(file),
      header_(header),
      emitter_(emitter),
      scratch_(scratch),
      axes_(header.vertices().properties.size(), -1),
      vertices_(file, header.float32(), scratch) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes_[header.coordinates[axis]] = static_cast<int>(axis);
  }
}

MeshLines PlyAscii::lines_from(TextPosition begin) const {
  return {file_, begin, header_.has_loose_lines ? LineComment::kHash : LineComment::kNone,
          static_cast<std::size_t>(scratch_.window_bytes())};
}

template <class TakeLine>
Result<FacePosition> PlyAscii::each_line(const PlyElement& element, const FacePosition& from,
                                         const TakeLine& take_line) {
  MeshLines lines = lines_from(from.position);
  // A record without properties would be an empty line, and empty lines are ignored.
  const std::uint64_t count = element.properties.empty() ? 0 : element.count;
  for (std::uint64_t record = from.record; record < count; ++record) {
    if (!lines.next_filled()) {
      if (lines.failure()) return *lines.failure();
      return line_error(lines.after(), "the file ends at record " + std::to_string(record) +
                                           " of " + std::to_string(count) + " '" +
                                           printable(element.name) + "'");
    }
    const Result<bool> taken = take_line(record, lines);
    if (!taken) return taken.error();
    if (!*taken) return FacePosition{lines.position(), record, 0};
    if (const auto told = emitter_.advance(lines.after().offset); !told) return told.error();
  }
  return FacePosition{lines.after(), count, 0};
}

Result<TextPosition> PlyAscii::skip(const PlyElement& element, TextPosition begin) {
  const auto end = each_line(element, {begin, 0, 0},
                             [](std::uint64_t, const MeshLines&) -> Result<bool> { return true; });
  if (!end) return end.error();
  return end->position;
}

Result<TextPosition> PlyAscii::vertices(TextPosition begin) {
  const auto end = each_line(header_.vertices(), {begin, 0, 0},
                             [this](std::uint64_t, const MeshLines& lines) -> Result<bool> {
                               if (const auto taken = take_vertex(lines); !taken)
                                 return taken.error();
                               return true;
                             });
  if (!end) return end.error();
  if (const auto finished = vertices_.finish(); !finished) return finished.error();
  emitter_.set_vertex_count(vertices_.count());
  return end->position;
}

Result<TextPosition> PlyAscii::faces(TextPosition begin) {
  FaceVertexJoin join(vertices_, 0, scratch_, true, emitter_);
  const auto each_face = [this](const FacePosition& from, const auto& take) {
    return each_line(header_.faces(), from,
                     [&](std::uint64_t record, const MeshLines& lines) -> Result<bool> {
                       if (const auto taken = take_face(lines); !taken) return taken.error();
                       return take(Face(record, indices_));
                     });
  };
  const auto end = join.deliver({begin, 0, 0}, file_.size_bytes(), each_face);
  if (!end) return end.error();
  return end->position;
}

Result<void> PlyAscii::expect_end(TextPosition end) {
  MeshLines lines = lines_from(end);
  if (!lines.next_filled())
    return lines.failure() ? Result<void>(*lines.failure()) : Result<void>();
  return line_error(lines.position(),
                    "text follows the last record, so a count in the header is too small");
}

Result<void> PlyAscii::take_vertex(const MeshLines& lines) {
  Row row(lines);
  std::array<double, 3> position = {};
  const std::vector<PlyProperty>& properties = header_.vertices().properties;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (axes_[i] < 0) {
      if (Result<void> passed = row.pass(properties[i]); !passed) return passed;
      continue;
    }
    const Result<double> value = row.real(properties[i]);
    if (!value) return value.error();
    position[static_cast<std::size_t>(axes_[i])] = *value;
  }
  if (const auto added = vertices_.add({position[0], position[1], position[2]}); !added)
    return added;
  return header_.has_loose_lines ? row.expect_rest(words_behind_vertex_) : row.expect_end();
}

Result<void> PlyAscii::take_face(const MeshLines& lines) {
  Row row(lines);
  indices_.clear();
  const std::vector<PlyProperty>& properties = header_.faces().properties;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    if (i != header_.index_list) {
      if (Result<void> passed = row.pass(properties[i]); !passed) return passed;
      continue;
    }
    const Result<std::int64_t> length = row.length(properties[i]);
    if (!length) return length.error();
    for (std::int64_t k = 0; k < *length; ++k) {
      const Result<std::int64_t> index = row.integer(properties[i]);
      if (!index) return index.error();
      indices_.push_back(*index);
    }
  }
  return header_.has_loose_lines ? Result<void>() : row.expect_end();
}

}  // namespace planetree::octree
