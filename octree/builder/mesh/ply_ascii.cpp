#include "octree/builder/mesh/ply_ascii.h"

#include <array>
#include <utility>

namespace planetree::octree {

namespace {

constexpr std::size_t kCoordinates = 3;

}  // namespace

PlyAscii::PlyAscii(const MeshFile& file, const PlyHeader& header, const PlyAttributes& attributes,
                   FanEmitter& emitter, MeshScratch& scratch)
    : file_(file),
      header_(header),
      attributes_(attributes),
      emitter_(emitter),
      scratch_(scratch),
      numbers_(header.vertices().properties.size(), -1),
      // Where the body begins on the line of the header, lines tell nothing.
      layout_{header.has_loose_lines && header.body.records == 0, false, header.has_loose_lines,
              static_cast<std::size_t>(scratch.window_bytes())},
      face_words_(header, attributes) {
  for (std::size_t axis = 0; axis < kCoordinates; ++axis)
    numbers_[header.coordinates[axis]] = static_cast<int>(axis);
  for (std::size_t i = 0; i < attributes.vertex_numbers.size(); ++i)
    numbers_[attributes.vertex_numbers[i]] = static_cast<int>(kCoordinates + i);
}

template <class Take>
Result<FacePosition> PlyAscii::each_record(const PlyElement& element, const FacePosition& from,
                                           const Take& take) {
  PlyWords words(file_, from.position, layout_);
  words.note_rounded(rounded_);
  // A record without properties has no words.
  const std::uint64_t count = element.properties.empty() ? 0 : element.count;
  for (std::uint64_t record = from.record; record < count; ++record) {
    if (!words.begin_record()) return words.ended(element, record);
    const Result<bool> taken = take(record, words);
    if (!taken) return taken.error();
    if (!*taken) return FacePosition{words.begin(), record, 0};
    if (const auto told = emitter_.advance(words.bytes_done()); !told) return told.error();
  }
  return FacePosition{words.after(), count, 0};
}

Result<TextPosition> PlyAscii::skip(const PlyElement& element, TextPosition begin) {
  const auto end =
      each_record(element, {begin, 0, 0}, [&](std::uint64_t, PlyWords& words) -> Result<bool> {
        if (words.pass(element, 0, element.properties.size()) && words.end_record()) return true;
        return *words.error();
      });
  if (!end) return end.error();
  return end->position;
}

Result<TextPosition> PlyAscii::vertices(TextPosition begin) {
  Result<TextPosition> end = read_vertices(begin);
  // A body of one line has faces behind the vertices.
  may_be_words_ |= header_.numbers_behind_vertex && vertices_->count() == 1 &&
                   words_behind_vertex_.value_or(0) >= kCoordinates;
  if (!end && may_be_words_ && end.error().code == ErrorCode::kBadInput) {
    const Error of_lines = end.error();
    layout_.is_loose = false;
    end = read_vertices(begin);
    if (!end && end.error().code == ErrorCode::kBadInput) return of_lines;
  }
  if (!end) return end;
  if (const auto finished = vertices_->finish(); !finished) return finished.error();
  emitter_.set_vertex_count(vertices_->count());
  return end;
}

Result<TextPosition> PlyAscii::read_vertices(TextPosition begin) {
  vertices_.emplace(file_, header_.float32(), attributes_.of_vertices,
                    MeshScratch::text_bytes(scratch_.memory_bytes()), scratch_);
  const auto take = [this](std::uint64_t, PlyWords& words) { return take_vertex(words); };
  const auto end = each_record(header_.vertices(), {begin, 0, 0}, take);
  if (!end) return end.error();
  return end->position;
}

Result<bool> PlyAscii::take_vertex(PlyWords& words) {
  std::array<double, kCoordinates + PlyAttributes::kMaxNumbers> numbers = {};
  const std::vector<PlyProperty>& properties = header_.vertices().properties;
  for (std::size_t i = 0; i < properties.size(); ++i) {
    const int number = numbers_[i];
    const auto at = static_cast<std::size_t>(number);
    const bool read = number < 0          ? words.pass(properties[i])
                      : at < kCoordinates ? words.real(properties[i], numbers[at])
                                          : words.number(properties[i], numbers[at]);
    if (!read) return *words.error();
  }
  const auto behind = std::span(numbers).subspan(kCoordinates, attributes_.vertex_numbers.size());
  const auto added = vertices_->add({numbers[0], numbers[1], numbers[2]},
                                    vertex_attributes(header_, attributes_, behind));
  if (!added) return added.error();
  if (layout_.is_loose) return end_loose_vertex(words);
  const std::size_t more = header_.numbers_behind_vertex.value_or(0);
  for (std::size_t i = 0; i < more; ++i)
    if (!words.pass(properties.front())) return *words.error();
  return words.end_record() ? Result<bool>(true) : *words.error();
}

Result<bool> PlyAscii::end_loose_vertex(PlyWords& words) {
  // Whether a line with so many words behind a vertex may have several vertices.
  const auto has_several = [this](std::uint64_t left) {
    if (!header_.numbers_behind_vertex) return false;
    const std::uint64_t each = kCoordinates + *header_.numbers_behind_vertex;
    return kCoordinates + left > each && (kCoordinates + left) % each == 0;
  };
  if (words.has_crossed()) {
    may_be_words_ = header_.numbers_behind_vertex.has_value();
    return words.crossing_error();
  }
  const std::uint64_t left = words.words_left_on_line();
  if (!words_behind_vertex_) {
    words_behind_vertex_ = left;
    may_be_words_ = has_several(left);
  }
  if (left == *words_behind_vertex_) return true;
  may_be_words_ |= has_several(left);
  return words.error_here(
      "a vertex of more or fewer numbers than the first, so a count in the header may be wrong");
}

Result<TextPosition> PlyAscii::faces(TextPosition begin) {
  FaceVertexJoin join(*vertices_, 0, scratch_, true, emitter_);
  if (layout_.is_loose && header_.faces().count > 1) {
    const Result<bool> share = faces_share_lines(begin);
    if (!share) return share.error();
    layout_.is_loose = !*share;
  }
  const auto take_each_face = [this](const FacePosition& from, const auto& take) {
    return each_record(header_.faces(), from,
                       [&](std::uint64_t record, PlyWords& words) -> Result<bool> {
                         if (const auto taken = take_face(words); !taken) return taken.error();
                         const auto* const attributes = face_words_.finish(record, indices_.size());
                         emitter_.set_value(face_words_.value());
                         return take(IndexedFace(record, indices_, 0, attributes));
                       });
  };
  const auto take_each_triangle = [this](const FacePosition& from, const auto& take) {
    return each_triangle(from, take);
  };
  const FacePosition first{begin, 0, 0};
  const auto end = header_.has_strips ? join.deliver(first, file_.size_bytes(), take_each_triangle)
                                      : join.deliver(first, file_.size_bytes(), take_each_face);
  if (!end) return end.error();
  return end->position;
}

Result<void> PlyAscii::take_face(PlyWords& words) {
  indices_.clear();
  const PlyElement& element = header_.faces();
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    std::int64_t value = 0;
    bool read =
        i == header_.index_list ? words.length(property, value) : face_words_.take(i, words);
    for (std::int64_t left = value; read && left > 0; --left) {
      read = words.integer(property, value);
      indices_.push_back(value);
    }
    if (!read) return *words.error();
  }
  if (!words.end_record()) return *words.error();
  // Behind a face on one line is its colour. Behind one that goes over lines anything may be.
  if (layout_.is_loose && words.has_crossed() && words.words_left_on_line() > 0)
    return words.error_here("a face that goes over lines, with further words behind it");
  return {};
}

Result<bool> PlyAscii::faces_share_lines(TextPosition begin) {
  PlyWords words(file_, begin, layout_);
  if (!words.begin_record()) return false;
  // Two triangles on a line look like one with a colour.
  std::uint64_t faces = 0;
  std::int64_t corners = 0, index = 0;
  while (words.integer_on_line(corners)) {
    if (corners < 3) return false;
    for (; corners > 0; --corners)
      if (!words.integer_on_line(index) || index < 0 ||
          static_cast<std::uint64_t>(index) >= vertices_->count())
        return false;
    ++faces;
  }
  if (faces < 2) return false;
  std::uint64_t lines = 1;
  while (lines < header_.faces().count && words.begin_record()) ++lines;
  if (words.error()) return *words.error();
  return lines < header_.faces().count;
}

template <class Take>
Result<FacePosition> PlyAscii::each_triangle(const FacePosition& from, const Take& take) {
  const PlyElement& element = header_.faces();
  const PlyProperty& list = element.properties[header_.index_list];
  // Without a triangle before it, reading begins at the first list again.
  bool resumes = from.record > 0;
  StripPosition at =
      resumes ? *stop_
              : StripPosition{
                    PlyStrips(list.type), {from.position, from.position, {}, 0, {}, false}, 0, 0};
  at.words.is_within_line |= !resumes && from.position.records > 0;
  PlyWords words(file_, at.words, layout_);
  words.allow_long_records();
  while (at.record < element.count) {
    if (!resumes) {
      if (!words.begin_record()) return words.ended(element, at.record);
      at.strips.begin_list();
      if (!words.pass(element, 0, header_.index_list) || !words.length(list, at.left))
        return *words.error();
    }
    for (std::int64_t index = 0; resumes || at.left > 0; resumes = false) {
      if (!resumes) {
        if (!words.integer(list, index)) return *words.error();
        --at.left;
        if (!at.strips.add(index, words.line())) continue;
      }
      const Result<bool> taken = take(at.strips.triangle());
      if (!taken) return taken.error();
      if (!*taken) {
        at.words = words.state();
        stop_ = at;
        const std::uint64_t number = at.strips.number();
        return FacePosition{number == 0 ? from.position : at.words.next, number, 0};
      }
      at.strips.count_triangle();
      if (const auto told = emitter_.advance(words.bytes_done()); !told) return told.error();
    }
    if (!words.pass(element, header_.index_list + 1, element.properties.size()) ||
        !words.end_record())
      return *words.error();
    ++at.record;
  }
  left_out_ = at.strips.left_out();
  return FacePosition{words.after(), at.strips.number(), 0};
}

Result<void> PlyAscii::expect_end(TextPosition end) {
  PlyWords words(file_, end, layout_);
  if (!words.begin_record()) return words.error() ? Result<void>(*words.error()) : Result<void>();
  if (words.begin().records > 0) return words.surplus_error();
  return words.error_here("text follows the last record, so a count in the header is too small");
}

std::vector<std::string> PlyAscii::notes() const {
  std::vector<std::string> notes;
  if (rounded_)
    notes.push_back(rounded_.counted("coordinate") +
                    " of more digits than the declared float holds, " + rounded_.first() +
                    ", rounded; --float64 reads them as doubles");
  if (left_out_)
    notes.push_back(left_out_.counted("triangle") +
                    " of strips with two equal vertices left out, " + left_out_.first());
  add_uv_note(face_words_.wrong_uvs(), notes);
  return notes;
}

}  // namespace planetree::octree
