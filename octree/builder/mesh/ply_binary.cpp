#include "octree/builder/mesh/ply_binary.h"

#include <array>
#include <bit>
#include <cinttypes>

namespace planetree::octree {

namespace {

bool needs_swap(PlyEncoding encoding) {
  const bool file_little = encoding == PlyEncoding::kBinaryLittleEndian;
  return file_little != (std::endian::native == std::endian::little);
}

}  // namespace

/// A face whose list is in the file.
class PlyBinary::Face {
 public:
  Face(std::uint64_t record, const ListSpan& list, ScalarType type, bool swap, MeshWindow& window,
       PlyFaceBytes& attributes)
      : record_(record),
        list_(list),
        type_(type),
        index_bytes_(size_bytes(type)),
        swap_(swap),
        window_(window),
        attributes_(attributes) {}

  [[nodiscard]] std::uint64_t record() const { return record_; }
  [[nodiscard]] std::uint64_t size() const { return list_.count; }
  bool value_at(std::uint64_t k, std::int64_t& value) const {
    const std::byte* const at = window_.at(list_.offset + k * index_bytes_, index_bytes_);
    if (at == nullptr) return fail(window_.failure());
    value = load_integer(type_, at, swap_);
    return true;
  }
  [[nodiscard]] static std::int64_t vertices_before() { return 0; }
  [[nodiscard]] static std::uint64_t uv_vertex(std::uint64_t) { return FaceAttributes::kNone; }
  bool add_attributes(std::uint64_t k, CornerAttributes& corner) const {
    return attributes_.add_to(k, corner) || fail(attributes_.failure());
  }
  [[nodiscard]] const Error& failure() const { return *failure_; }

 private:
  bool fail(const Error& error) const {
    failure_ = &error;
    return false;
  }

  const std::uint64_t record_;
  const ListSpan& list_;
  const ScalarType type_;
  const std::uint64_t index_bytes_;
  const bool swap_;
  MeshWindow& window_;
  PlyFaceBytes& attributes_;
  mutable const Error* failure_ = nullptr;
};

PlyBinary::PlyBinary(const MeshFile& file, const PlyHeader& header, const PlyAttributes& attributes,
                     FanEmitter& emitter, MeshScratch& scratch)
    : file_(file),
      header_(header),
      attributes_(attributes),
      emitter_(emitter),
      scratch_(scratch),
      records_(file, needs_swap(header.encoding), static_cast<std::size_t>(scratch.window_bytes())),
      vertices_(file, header, attributes, records_.swap()),
      face_bytes_(file, header, attributes, records_.window(), records_.swap()) {}

Result<TextPosition> PlyBinary::skip(const PlyElement& element, TextPosition begin) {
  if (Result<void> space = records_.check_space(element, begin.offset); !space)
    return space.error();
  std::uint64_t position = begin.offset;
  if (!element.has_list()) {
    return TextPosition{position + element.count * element.min_record_bytes(), 0};
  }
  for (std::uint64_t record = 0; record < element.count; ++record) {
    const auto walked =
        records_.walk(element, record, position, [](std::size_t, std::uint64_t, std::uint64_t) {});
    if (!walked) return walked.error();
  }
  return TextPosition{position, 0};
}

Result<TextPosition> PlyBinary::vertices(TextPosition begin) {
  const PlyElement& element = header_.vertices();
  if (Result<void> space = records_.check_space(element, begin.offset); !space)
    return space.error();
  emitter_.set_vertex_count(element.count);
  if (element.has_list()) return spill_vertices(begin);
  vertices_.set(begin.offset, element.count);
  return TextPosition{begin.offset + element.count * vertices_.file_record_bytes(), 0};
}

Result<TextPosition> PlyBinary::spill_vertices(TextPosition begin) {
  const PlyElement& element = header_.vertices();
  spilled_.emplace(file_, header_.float32(), attributes_.of_vertices,
                   MeshScratch::text_bytes(scratch_.memory_bytes()), scratch_);
  std::vector<std::uint64_t> offsets(element.properties.size());
  std::uint64_t position = begin.offset;
  for (std::uint64_t record = 0; record < element.count; ++record) {
    const auto walked = records_.walk(
        element, record, position,
        [&](std::size_t i, std::uint64_t offset, std::uint64_t) { offsets[i] = offset; });
    if (!walked) return walked.error();
    if (const auto spilled = spill_vertex(offsets); !spilled) return spilled.error();
    if (const auto told = emitter_.advance(position); !told) return told.error();
  }
  if (const auto finished = spilled_->finish(); !finished) return finished.error();
  return TextPosition{position, 0};
}

Result<void> PlyBinary::spill_vertex(const std::vector<std::uint64_t>& offsets) {
  Vec3 position;
  double* const axes[] = {&position.x, &position.y, &position.z};
  for (std::size_t axis = 0; axis < header_.coordinates.size(); ++axis)
    if (!read_number(offsets, header_.coordinates[axis], *axes[axis]))
      return records_.window().failure();
  std::array<double, PlyAttributes::kMaxNumbers> numbers = {};
  const std::vector<std::size_t>& properties = attributes_.vertex_numbers;
  for (std::size_t i = 0; i < properties.size(); ++i)
    if (!read_number(offsets, properties[i], numbers[i])) return records_.window().failure();
  return spilled_->add(position, vertex_attributes(header_, attributes_,
                                                   std::span(numbers).first(properties.size())));
}

bool PlyBinary::read_number(const std::vector<std::uint64_t>& offsets, std::size_t property,
                            double& number) {
  const ScalarType type = header_.vertices().properties[property].type;
  const std::byte* const at = records_.window().at(offsets[property], size_bytes(type));
  if (at == nullptr) return false;
  number = load_real(type, at, records_.swap());
  return true;
}

Result<TextPosition> PlyBinary::faces(TextPosition begin) {
  if (Result<void> space = records_.check_space(header_.faces(), begin.offset); !space)
    return space.error();
  MeshVertices* vertices = &vertices_;
  if (spilled_) vertices = &*spilled_;
  FaceVertexJoin join(*vertices, 0, scratch_, spilled_.has_value(), emitter_);
  const FacePosition first{begin, 0, 0};
  const auto end = header_.has_strips
                       ? join.deliver(first, file_.size_bytes(),
                                      [this](const FacePosition& from, const auto& take) {
                                        return each_triangle(from, take);
                                      })
                       : join.deliver(first, file_.size_bytes(),
                                      [this](const FacePosition& from, const auto& take) {
                                        return each_face(from, take);
                                      });
  if (!end) return end.error();
  return end->position;
}

template <class Take>
Result<FacePosition> PlyBinary::each_face(const FacePosition& from, const Take& take) {
  const PlyElement& element = header_.faces();
  const ScalarType index_type = element.properties[header_.index_list].type;
  std::uint64_t position = from.position.offset;
  ListSpan list;
  for (std::uint64_t face = from.record; face < element.count; ++face) {
    const std::uint64_t face_begin = position;
    const auto walked = walk_face(face, position, list);
    if (!walked) return walked.error();
    const auto read = face_bytes_.read(face, list.count, position - face_begin);
    if (!read) return read.error();
    emitter_.set_value(face_bytes_.value());
    const Result<bool> taken =
        take(Face(face, list, index_type, records_.swap(), records_.window(), face_bytes_));
    if (!taken) return taken.error();
    if (!*taken) return FacePosition{{face_begin, 0}, face, 0};
    if (const auto told = emitter_.advance(position); !told) return told.error();
  }
  return FacePosition{{position, 0}, element.count, 0};
}

template <class Take>
Result<FacePosition> PlyBinary::each_triangle(const FacePosition& from, const Take& take) {
  const PlyElement& element = header_.faces();
  const ScalarType type = element.properties[header_.index_list].type;
  const std::uint64_t index_bytes = size_bytes(type);
  // Without a triangle before it, reading begins at the first list again.
  bool resumes = from.record > 0;
  StripPosition at = resumes ? *stop_ : StripPosition{PlyStrips(type), 0, from.position.offset, {}};
  while (resumes || at.record < element.count) {
    if (!resumes) {
      at.strips.begin_list();
      const auto walked = walk_face(at.record++, at.position, at.list);
      if (!walked) return walked.error();
    }
    for (; resumes || at.list.count > 0; resumes = false) {
      if (!resumes) {
        const std::byte* const index = records_.window().at(at.list.offset, index_bytes);
        if (index == nullptr) return records_.window().failure();
        at.list = {at.list.offset + index_bytes, at.list.count - 1};
        if (!at.strips.add(load_integer(type, index, records_.swap()), 0)) continue;
      }
      const Result<bool> taken = take(at.strips.triangle());
      if (!taken) return taken.error();
      if (!*taken) {
        stop_ = at;
        const std::uint64_t number = at.strips.number();
        return FacePosition{number == 0 ? from.position : TextPosition{at.list.offset, 0}, number,
                            0};
      }
      at.strips.count_triangle();
      if (const auto told = emitter_.advance(at.list.offset); !told) return told.error();
    }
  }
  left_out_ = at.strips.left_out();
  return FacePosition{{at.position, 0}, at.strips.number(), 0};
}

Result<void> PlyBinary::expect_end(TextPosition end) {
  // White space, such as a last newline, is no record.
  for (std::uint64_t at = end.offset; at < file_.size_bytes(); ++at) {
    const std::byte* const byte = records_.window().at(at, 1);
    if (byte == nullptr) return records_.window().failure();
    if (is_space(static_cast<char>(*byte))) continue;
    return make_error(ErrorCode::kBadInput, Error::kNowhere, end.offset,
                      "byte %" PRIu64 ": %" PRIu64
                      " bytes follow the last record: a count in the header is too small; export "
                      "it again",
                      end.offset, file_.size_bytes() - end.offset);
  }
  return {};
}

std::vector<std::string> PlyBinary::notes() const {
  std::vector<std::string> notes;
  if (left_out_)
    notes.push_back(left_out_.counted("triangle") + " of strips with two equal vertices left out");
  add_uv_note(face_bytes_.wrong_uvs(), notes);
  return notes;
}

}  // namespace planetree::octree
