#include "tools/points/las_header.h"

#include <bit>
#include <cinttypes>
#include <cmath>

#include "octree/builder/mesh/stream/scalar_type.h"

namespace planetree::tools {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view kLasMagic = "LASF"sv;
constexpr bool kSwapsLas = std::endian::native == std::endian::big;
constexpr const char* kExportLas = "export the file again";

// Bytes of the header's fields.
constexpr std::size_t kMajorAt = 24, kMinorAt = 25, kHeaderBytesAt = 94, kRecordsAt = 96,
                      kNotesAt = 100, kFormatAt = 104, kRecordBytesAt = 105, kShortCountAt = 107,
                      kScaleAt = 131, kOffsetAt = 155, kLongCountAt = 247;

/// Lengths of the header of versions 1.0 to 1.4.
constexpr std::uint16_t kVersionBytes[] = {227, 227, 227, 235, LasHeader::kMaxBytes};
/// Lengths of the records of point data formats 0 to 10. Longer ones have extra bytes at their end.
constexpr std::uint16_t kFormatBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
/// Writers of LAZ set one of these bits of the format.
constexpr unsigned kCompressedBits = 0xc0;

template <class Number>
Number las_field(std::string_view front, std::size_t at) {
  return octree::load<Number>(reinterpret_cast<const std::byte*>(front.data()) + at, kSwapsLas);
}

/// The bytes of the header by its version, which is checked.
Result<std::uint16_t> version_bytes(std::string_view front) {
  if (front.size() <= kMinorAt)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, front.size(),
                      "the file ends in its LAS header; copy or export it again");
  const unsigned major = las_field<std::uint8_t>(front, kMajorAt),
                 minor = las_field<std::uint8_t>(front, kMinorAt);
  if (major != 1 || minor >= std::size(kVersionBytes))
    return make_error(ErrorCode::kBadInput, Error::kNowhere, kMajorAt,
                      "the version of this LAS file is %u.%u, and 1.0 to 1.4 are known; save it as "
                      "LAS 1.4",
                      major, minor);
  const std::uint16_t wanted = kVersionBytes[minor];
  if (front.size() < wanted)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, front.size(),
                      "the file ends in its LAS header of %u bytes; copy or export it again",
                      unsigned{wanted});
  return wanted;
}

Result<void> check_places(const LasHeader& header, std::uint16_t wanted) {
  if (header.bytes < wanted)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, kHeaderBytesAt,
                      "the LAS header says that it has %u bytes, but its version has %u; %s",
                      unsigned{header.bytes}, unsigned{wanted}, kExportLas);
  if (header.records_at < header.bytes)
    return make_error(ErrorCode::kBadInput, Error::kNowhere, kRecordsAt,
                      "the points begin at byte %" PRIu32 ", within the LAS header of %u bytes; %s",
                      header.records_at, unsigned{header.bytes}, kExportLas);
  return {};
}

Result<void> check_records(const LasHeader& header, unsigned format) {
  if ((format & kCompressedBits) != 0) return compressed_las();
  if (format >= std::size(kFormatBytes))
    return make_error(ErrorCode::kBadInput, Error::kNowhere, kFormatAt,
                      "the point data format is %u, and 0 to 10 are known; %s as LAS 1.4", format,
                      kExportLas);
  if (header.record_bytes < kFormatBytes[format])
    return make_error(ErrorCode::kBadInput, Error::kNowhere, kRecordBytesAt,
                      "point records have %u bytes, but those of format %u have at least %u; %s",
                      unsigned{header.record_bytes}, format, unsigned{kFormatBytes[format]},
                      kExportLas);
  return {};
}

Result<void> check_frame(const LasHeader& header) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double scale = header.scale[axis], offset = header.offset[axis];
    const char name = static_cast<char>('x' + axis);
    if (!std::isfinite(scale) || scale == 0)
      return make_error(ErrorCode::kBadInput, Error::kNowhere, kScaleAt + sizeof(double) * axis,
                        "the scale of %c is %g, which gives no positions; %s", name, scale,
                        kExportLas);
    if (!std::isfinite(offset))
      return make_error(ErrorCode::kBadInput, Error::kNowhere, kOffsetAt + sizeof(double) * axis,
                        "the offset of %c is %g, which gives no positions; %s", name, offset,
                        kExportLas);
  }
  return {};
}

/// Version 1.4 has a count of 64 bits. The old one of 32 bits is 0 where it cannot be told to older
/// readers, and some writers fill in only the old one.
std::uint64_t count_of(std::string_view front, std::uint16_t header_bytes) {
  const std::uint64_t count =
      header_bytes == LasHeader::kMaxBytes ? las_field<std::uint64_t>(front, kLongCountAt) : 0;
  return count != 0 ? count : las_field<std::uint32_t>(front, kShortCountAt);
}

}  // namespace

Vec3 LasHeader::position(const std::byte* record) const noexcept {
  const auto place = [&](std::size_t axis) {
    const auto steps = octree::load<std::int32_t>(record + sizeof(std::int32_t) * axis, kSwapsLas);
    return steps * scale[axis] + offset[axis];
  };
  return {place(0), place(1), place(2)};
}

bool is_las(std::string_view front) noexcept { return front.starts_with(kLasMagic); }

Error compressed_las() {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "this is LAZ, a LAS file whose points are compressed; decompress it with "
                    "laszip or PDAL (pdal translate in.laz out.las)");
}

Result<LasHeader> parse_las_header(std::string_view front) {
  const auto wanted = version_bytes(front);
  if (!wanted) return wanted.error();
  LasHeader header;
  header.bytes = las_field<std::uint16_t>(front, kHeaderBytesAt);
  header.records_at = las_field<std::uint32_t>(front, kRecordsAt);
  header.notes = las_field<std::uint32_t>(front, kNotesAt);
  header.record_bytes = las_field<std::uint16_t>(front, kRecordBytesAt);
  header.points = count_of(front, *wanted);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.scale[axis] = las_field<double>(front, kScaleAt + sizeof(double) * axis);
    header.offset[axis] = las_field<double>(front, kOffsetAt + sizeof(double) * axis);
  }
  const unsigned format = las_field<std::uint8_t>(front, kFormatAt);
  for (const auto& checked :
       {check_places(header, *wanted), check_records(header, format), check_frame(header)})
    if (!checked) return checked.error();
  return header;
}

}  // namespace planetree::tools
