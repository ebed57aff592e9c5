#include "octree/build/ply_ascii.h"

#include <array>
#include <cinttypes>
#include <optional>
#include <string>

namespace planetree::octree {

namespace {

Error line_error(const TextPlace& place, const std::string& cause) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, place.offset,
                    "line %" PRIu64 ": %s; copy or export the mesh again", place.line,
                    cause.c_str());
}

/// The line's words, taken as the header declares them.
class Row {
 public:
  explicit Row(const LineScanner& lines) : rest_(lines.line()), place_(lines.place()) {}

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

  /// Of a list; its items follow.
  Result<std::int64_t> length(const PlyProperty& property) {
    const Result<std::int64_t> length = integer(property);
    if (length && *length < 0) {
      return error("list '" + printable(property.name) + "' has a negative length");
    }
    return length;
  }

  /// In the precision the header declares, whatever digits the line has.
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

  /// As many words must be left as were the first time, when `count` is set.
  Result<void> expect_rest(std::optional<std::uint64_t>& count) {
    std::uint64_t left = 0;
    while (!take_word(rest_).empty()) ++left;
    if (!count) count = left;
    if (left == *count) return {};
    return error(
        "a vertex of more or fewer numbers than the first, so a count in the header may be wrong");
  }

 private:
  [[nodiscard]] Error error(const std::string& cause) const { return line_error(place_, cause); }

  std::string_view rest_;
  TextPlace place_;
};

}  // namespace

PlyAscii::PlyAscii(MeshFile& file, const PlyHeader& header, MeshDelivery& delivery)
    : file_(file),
      header_(header),
      delivery_(delivery),
      axes_(header.vertices().properties.size(), -1),
      float32_(header.float32()) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    axes_[header.coordinates[axis]] = static_cast<int>(axis);
  }
}

LineScanner PlyAscii::lines_from(TextPlace begin) const noexcept {
  return LineScanner(file_.text(), begin, LineEnd::kAny,
                     header_.has_loose_lines ? LineComment::kHash : LineComment::kNone);
}

template <class TakeLine>
Result<TextPlace> PlyAscii::each_line(const PlyElement& element, TextPlace begin,
                                      const TakeLine& take_line) {
  LineScanner lines = lines_from(begin);
  // A record without properties is an empty line, and those are passed over.
  const std::uint64_t count = element.properties.empty() ? 0 : element.count;
  for (std::uint64_t record = 0; record < count; ++record) {
    if (!lines.next_filled()) {
      return line_error(lines.after(), "the file ends at record " + std::to_string(record) +
                                           " of " + std::to_string(count) + " '" +
                                           printable(element.name) + "'");
    }
    file_.touch(lines.place().offset);
    if (Result<void> taken = take_line(record, lines); !taken) return taken.error();
    delivery_.advance(lines.after().offset);
  }
  return lines.after();
}

Result<TextPlace> PlyAscii::skip(const PlyElement& element, TextPlace begin) {
  return each_line(element, begin,
                   [](std::uint64_t, const LineScanner&) { return Result<void>(); });
}

Result<TextPlace> PlyAscii::vertices(TextPlace begin) {
  Result<TextPlace> end =
      each_line(header_.vertices(), begin,
                [this](std::uint64_t, const LineScanner& lines) { return take_vertex(lines); });
  delivery_.set_vertex_count(vertex_count_);
  return end;
}

Result<TextPlace> PlyAscii::faces(TextPlace begin) {
  return each_line(
      header_.faces(), begin, [this](std::uint64_t face, const LineScanner& lines) -> Result<void> {
        if (Result<void> taken = take_face(lines); !taken) return taken;
        return delivery_.polygon(face, indices_.size(),
                                 [this](std::uint64_t k) { return corner(indices_[k]); });
      });
}

Result<void> PlyAscii::expect_end(TextPlace end) {
  LineScanner lines = lines_from(end);
  if (!lines.next_filled()) return {};
  return line_error(lines.place(),
                    "text follows the last record, so a count in the header is too small");
}

Result<void> PlyAscii::take_vertex(const LineScanner& lines) {
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
  for (const double value : position) {
    if (float32_) {
      floats_.push_back(static_cast<float>(value));
    } else {
      doubles_.push_back(value);
    }
  }
  ++vertex_count_;
  return header_.has_loose_lines ? row.expect_rest(words_behind_vertex_) : row.expect_end();
}

Result<void> PlyAscii::take_face(const LineScanner& lines) {
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

MeshCorner PlyAscii::corner(std::int64_t index) const noexcept {
  const bool in_range = index >= 0 && static_cast<std::uint64_t>(index) < vertex_count_;
  if (!in_range) return {{}, index, false};
  const std::size_t at = 3 * static_cast<std::size_t>(index);
  if (!float32_) return {{doubles_[at], doubles_[at + 1], doubles_[at + 2]}, index, true};
  return {{static_cast<double>(floats_[at]), static_cast<double>(floats_[at + 1]),
           static_cast<double>(floats_[at + 2])},
          index,
          true};
}

}  // namespace planetree::octree
