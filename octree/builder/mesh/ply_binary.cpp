#include "octree/builder/mesh/ply_binary.h"

#include <bit>
#include <cinttypes>

namespace planetree::octree {

namespace {

constexpr std::size_t kNoProperty = ~std::size_t{0};

bool needs_swap(PlyEncoding encoding) {
  const bool file_little = encoding == PlyEncoding::kBinaryLittleEndian;
  return file_little != (std::endian::native == std::endian::little);
}

}  // namespace

/// A face whose list is in the file.
class PlyBinary::Face {
 public:
  Face(std::uint64_t record, const ListSpan& list, PlyType type, bool swap, MeshWindow& window)
      : record_(record),
        list_(list),
        type_(type),
        index_bytes_(size_bytes(type)),
        swap_(swap),
        window_(window) {}

  [[nodiscard]] std::uint64_t record() const { return record_; }
  [[nodiscard]] std::uint64_t size() const { return list_.count; }
  bool value_at(std::uint64_t k, std::int64_t& value) const {
    const std::byte* const at = window_.at(list_.offset + k * index_bytes_, index_bytes_);
    if (at == nullptr) return false;
    value = load_integer(type_, at, swap_);
    return true;
  }
  [[nodiscard]] static std::int64_t vertices_before() { return 0; }
  [[nodiscard]] const Error& failure() const { return window_.failure(); }

 private:
  const std::uint64_t record_;
  const ListSpan& list_;
  const PlyType type_;
  const std::uint64_t index_bytes_;
  const bool swap_;
  MeshWindow& window_;
};

PlyBinary::PlyBinary(const MeshFile& file, const PlyHeader& header, FanEmitter& emitter,
                     MeshScratch& scratch)
    : file_(file),
      header_(header),
      emitter_(emitter),
      scratch_(scratch),
      swap_(needs_swap(header.encoding)),
      vertices_(file, header, swap_),
      window_(file, static_cast<std::size_t>(scratch.window_bytes())) {}

Result<void> PlyBinary::check_space(const PlyElement& element, std::uint64_t begin) const {
  const std::uint64_t record_bytes = element.min_record_bytes();
  const std::uint64_t space = file_.size_bytes() - begin;
  if (record_bytes == 0 || element.count <= space / record_bytes) return {};
  return make_error(ErrorCode::kBadInput, Error::kNowhere, begin,
                    "byte %" PRIu64 ": %" PRIu64 " records '%s' of %" PRIu64
                    " bytes or more do not fit in the %" PRIu64
                    " left: truncated or miscounted; copy or export it again",
                    begin, element.count, printable(element.name).c_str(), record_bytes, space);
}

Error PlyBinary::bad_record(const PlyElement& element, std::uint64_t record,
                            std::uint64_t offset) const {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, offset,
                    "byte %" PRIu64 ": record %" PRIu64 " of %" PRIu64
                    " '%s' has a bad list length or is cut off: truncated or damaged; copy or "
                    "export it again",
                    offset, record, element.count, printable(element.name).c_str());
}

Result<TextPosition> PlyBinary::skip(const PlyElement& element, TextPosition begin) {
  if (Result<void> space = check_space(element, begin.offset); !space) return space.error();
  std::uint64_t position = begin.offset;
  if (!element.has_list()) {
    return TextPosition{position + element.count * element.min_record_bytes(), 0};
  }
  ListSpan list;
  for (std::uint64_t record = 0; record < element.count; ++record) {
    const auto walked = walk_record(element, record, kNoProperty, position, list);
    if (!walked) return walked.error();
  }
  return TextPosition{position, 0};
}

Result<TextPosition> PlyBinary::vertices(TextPosition begin) {
  const PlyElement& element = header_.vertices();
  if (Result<void> space = check_space(element, begin.offset); !space) return space.error();
  vertices_.set(begin.offset, element.count);
  emitter_.set_vertex_count(element.count);
  return TextPosition{begin.offset + element.count * vertices_.record_bytes(), 0};
}

Result<TextPosition> PlyBinary::faces(TextPosition begin) {
  if (Result<void> space = check_space(header_.faces(), begin.offset); !space) return space.error();
  FaceVertexJoin join(vertices_, 0, scratch_, false, emitter_);
  const auto end = join.deliver(
      {begin, 0, 0}, file_.size_bytes(),
      [this](const FacePosition& from, const auto& take) { return each_face(from, take); });
  if (!end) return end.error();
  return end->position;
}

template <class Take>
Result<FacePosition> PlyBinary::each_face(const FacePosition& from, const Take& take) {
  const PlyElement& element = header_.faces();
  const PlyType index_type = element.properties[header_.index_list].type;
  std::uint64_t position = from.position.offset;
  ListSpan list;
  for (std::uint64_t face = from.record; face < element.count; ++face) {
    const std::uint64_t face_begin = position;
    const auto walked = walk_record(element, face, header_.index_list, position, list);
    if (!walked) return walked.error();
    const Result<bool> taken = take(Face(face, list, index_type, swap_, window_));
    if (!taken) return taken.error();
    if (!*taken) return FacePosition{{face_begin, 0}, face, 0};
    if (const auto told = emitter_.advance(position); !told) return told.error();
  }
  return FacePosition{{position, 0}, element.count, 0};
}

Result<void> PlyBinary::expect_end(TextPosition end) {
  // White space, such as a last newline, is no record.
  for (std::uint64_t at = end.offset; at < file_.size_bytes(); ++at) {
    const std::byte* const byte = window_.at(at, 1);
    if (byte == nullptr) return window_.failure();
    if (is_space(static_cast<char>(*byte))) continue;
    return make_error(ErrorCode::kBadInput, Error::kNowhere, end.offset,
                      "byte %" PRIu64 ": %" PRIu64
                      " bytes follow the last record: a count in the header is too small; export "
                      "it again",
                      end.offset, file_.size_bytes() - end.offset);
  }
  return {};
}

Result<void> PlyBinary::walk_record(const PlyElement& element, std::uint64_t record,
                                    std::size_t list_property, std::uint64_t& position,
                                    ListSpan& list) {
  const std::uint64_t begin = position;
  read_failed_ = window_.record_at(begin) == nullptr;
  if (!read_failed_ && walk_properties(element, list_property, position, list)) return {};
  return read_failed_ ? window_.failure() : bad_record(element, record, begin);
}

bool PlyBinary::walk_properties(const PlyElement& element, std::size_t list_property,
                                std::uint64_t& position, ListSpan& list) {
  const std::uint64_t size = file_.size_bytes();
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    const std::uint64_t fixed_bytes =
        size_bytes(property.is_list ? property.count_type : property.type);
    if (size - position < fixed_bytes) return false;
    const std::uint64_t begin = position;
    position += fixed_bytes;
    if (!property.is_list) continue;
    const std::byte* const at = window_.at(begin, fixed_bytes);
    read_failed_ = at == nullptr;
    if (read_failed_) return false;
    const std::int64_t count = load_integer(property.count_type, at, swap_);
    // Counts have at most 32 bits, so the product below cannot overflow.
    if (count < 0) return false;
    const std::uint64_t list_bytes = static_cast<std::uint64_t>(count) * size_bytes(property.type);
    if (size - position < list_bytes) return false;
    if (i == list_property) list = {position, static_cast<std::uint64_t>(count)};
    position += list_bytes;
  }
  return true;
}

}  // namespace planetree::octree
