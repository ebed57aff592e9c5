#include "octree/build/ply_binary.h"

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

PlyBinary::PlyBinary(MeshFile& file, const PlyHeader& header, MeshDelivery& delivery)
    : file_(file), header_(header), delivery_(delivery), swap_(needs_swap(header.encoding)) {
  vertex_bytes_ = header.vertices().min_record_bytes();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    coordinate_offsets_[axis] = header.vertices().offset_of(header.coordinates[axis]);
    coordinate_types_[axis] = header.coordinate_type(axis);
  }
}

Result<void> PlyBinary::check_room(const PlyElement& element, std::uint64_t begin) const {
  const std::uint64_t record_bytes = element.min_record_bytes();
  const std::uint64_t room = file_.size_bytes() - begin;
  if (record_bytes == 0 || element.count <= room / record_bytes) return {};
  return make_error(ErrorCode::kBadInput, Error::kNowhere, begin,
                    "byte %" PRIu64 ": %" PRIu64 " records '%s' of %" PRIu64
                    " bytes or more do not fit in the %" PRIu64
                    " left: truncated or miscounted; copy or export it again",
                    begin, element.count, printable(element.name).c_str(), record_bytes, room);
}

Error PlyBinary::bad_record(const PlyElement& element, std::uint64_t record,
                            std::uint64_t offset) const {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, offset,
                    "byte %" PRIu64 ": record %" PRIu64 " of %" PRIu64
                    " '%s' has a bad list length or is cut off: truncated or damaged; copy or "
                    "export it again",
                    offset, record, element.count, printable(element.name).c_str());
}

Result<TextPlace> PlyBinary::skip(const PlyElement& element, TextPlace begin) {
  if (Result<void> room = check_room(element, begin.offset); !room) return room.error();
  std::uint64_t position = begin.offset;
  if (!element.has_list()) {
    return TextPlace{position + element.count * element.min_record_bytes(), 0};
  }
  ListSpan list;
  for (std::uint64_t record = 0; record < element.count; ++record) {
    const std::uint64_t record_begin = position;
    file_.touch(position);
    if (!walk_record(element, kNoProperty, position, list)) {
      return bad_record(element, record, record_begin);
    }
  }
  return TextPlace{position, 0};
}

Result<TextPlace> PlyBinary::vertices(TextPlace begin) {
  const PlyElement& element = header_.vertices();
  if (Result<void> room = check_room(element, begin.offset); !room) return room.error();
  vertices_begin_ = begin.offset;
  vertex_count_ = element.count;
  delivery_.set_vertex_count(vertex_count_);
  return TextPlace{begin.offset + vertex_count_ * vertex_bytes_, 0};
}

Result<TextPlace> PlyBinary::faces(TextPlace begin) {
  const PlyElement& element = header_.faces();
  if (Result<void> room = check_room(element, begin.offset); !room) return room.error();
  const PlyType index_type = element.properties[header_.index_list].type;
  const std::uint64_t index_bytes = size_bytes(index_type);
  std::uint64_t position = begin.offset;
  ListSpan list;
  for (std::uint64_t face = 0; face < element.count; ++face) {
    const std::uint64_t face_begin = position;
    file_.touch(position);
    if (!walk_record(element, header_.index_list, position, list)) {
      return bad_record(element, face, face_begin);
    }
    const auto corner_at = [&](std::uint64_t k) {
      const std::uint64_t offset = list.offset + k * index_bytes;
      file_.touch(offset);
      return corner(load_integer(index_type, file_.bytes() + offset, swap_));
    };
    if (Result<void> taken = delivery_.polygon(face, list.count, corner_at); !taken) {
      return taken.error();
    }
    delivery_.advance(position);
  }
  return TextPlace{position, 0};
}

Result<void> PlyBinary::expect_end(TextPlace end) {
  // A writer's last newline is no record.
  std::string_view rest = file_.text().substr(static_cast<std::size_t>(end.offset));
  if (take_word(rest).empty()) return {};
  return make_error(ErrorCode::kBadInput, Error::kNowhere, end.offset,
                    "byte %" PRIu64 ": %" PRIu64
                    " bytes follow the last record: a count in the header is too small; export it "
                    "again",
                    end.offset, file_.size_bytes() - end.offset);
}

bool PlyBinary::walk_record(const PlyElement& element, std::size_t list_property,
                            std::uint64_t& position, ListSpan& list) const noexcept {
  const std::uint64_t size = file_.size_bytes();
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& property = element.properties[i];
    const std::uint64_t fixed_bytes =
        size_bytes(property.is_list ? property.count_type : property.type);
    if (size - position < fixed_bytes) return false;
    const std::uint64_t begin = position;
    position += fixed_bytes;
    if (!property.is_list) continue;
    const std::int64_t count = load_integer(property.count_type, file_.bytes() + begin, swap_);
    // Counts have at most 32 bits, so the product below cannot overflow.
    if (count < 0) return false;
    const std::uint64_t list_bytes = static_cast<std::uint64_t>(count) * size_bytes(property.type);
    if (size - position < list_bytes) return false;
    if (i == list_property) list = {position, static_cast<std::uint64_t>(count)};
    position += list_bytes;
  }
  return true;
}

MeshCorner PlyBinary::corner(std::int64_t index) const noexcept {
  const bool in_range = index >= 0 && static_cast<std::uint64_t>(index) < vertex_count_;
  if (!in_range) return {{}, index, false};
  return {vertex(static_cast<std::uint64_t>(index)), index, true};
}

Vec3 PlyBinary::vertex(std::uint64_t index) const noexcept {
  const std::uint64_t offset = vertices_begin_ + index * vertex_bytes_;
  file_.touch(offset);
  const std::byte* const record = file_.bytes() + offset;
  return {load_real(coordinate_types_[0], record + coordinate_offsets_[0], swap_),
          load_real(coordinate_types_[1], record + coordinate_offsets_[1], swap_),
          load_real(coordinate_types_[2], record + coordinate_offsets_[2], swap_)};
}

}  // namespace planetree::octree
