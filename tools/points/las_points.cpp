#include "tools/points/las_points.h"

#include <algorithm>
#include <bit>
#include <cinttypes>
#include <cstring>
#include <string_view>
#include <utility>

#include "octree/builder/mesh/stream/scalar_type.h"

namespace planetree::tools {
namespace {

using namespace std::string_view_literals;

// More than the longest record has.
constexpr std::size_t kLasPieceBytes = std::size_t{1} << 18;

// A variable length record: a header, and as many bytes as it says.
constexpr std::size_t kNoteHeaderBytes = 54, kNoteUserAt = 2, kNoteLengthAt = 20;
constexpr std::string_view kLaszipUser = "laszip encoded\0"sv;

}  // namespace

Result<std::unique_ptr<PointReader>> LasPoints::create(std::string name, InputFile file,
                                                       std::string_view front) {
  const auto header = parse_las_header(front);
  if (!header) return header.error();
  std::unique_ptr<LasPoints> points(new LasPoints(std::move(name), std::move(file), *header));
  if (const auto skipped = points->skip_to_records(); !skipped) return skipped.error();
  return std::unique_ptr<PointReader>(std::move(points));
}

LasPoints::LasPoints(std::string name, InputFile file, const LasHeader& header)
    : PointReader(std::move(name)),
      file_(std::move(file)),
      header_(header),
      piece_(kLasPieceBytes) {}

/// Reads over what precedes the points. Of the variable length records only that of LASzip matters:
/// some of its files do not say in the header that they are compressed. Writers are known that
/// count more records than there are, so that records that do not fit are not looked at.
Result<void> LasPoints::skip_to_records() {
  if (const auto skipped = skip(header_.bytes); !skipped) return skipped;
  for (std::uint32_t i = 0; i < header_.notes; ++i) {
    if (header_.records_at - offset_ < kNoteHeaderBytes) break;
    const auto note = take(kNoteHeaderBytes);
    if (!note) return note.error();
    if (std::memcmp(note->data() + kNoteUserAt, kLaszipUser.data(), kLaszipUser.size()) == 0)
      return compressed_las();
    const auto length = octree::load<std::uint16_t>(note->data() + kNoteLengthAt,
                                                    std::endian::native == std::endian::big);
    const std::uint64_t left = header_.records_at - offset_;
    if (const auto skipped = skip(std::min<std::uint64_t>(length, left)); !skipped) return skipped;
  }
  return skip(header_.records_at - offset_);
}

Result<void> LasPoints::skip(std::uint64_t bytes) {
  while (bytes > 0) {
    const auto taken = take(std::min<std::uint64_t>(bytes, piece_.size()));
    if (!taken) return taken.error();
    bytes -= taken->size();
  }
  return {};
}

/// The next bytes, all of which must be there.
Result<std::span<const std::byte>> LasPoints::take(std::size_t bytes) {
  const auto read = file_.read(std::span(piece_).first(bytes));
  if (!read) return read.error();
  offset_ += *read;
  if (*read == bytes) return std::span<const std::byte>(piece_).first(bytes);
  return make_error(ErrorCode::kBadInput, Error::kNowhere, offset_,
                    "the file ends before its points, which begin at byte %" PRIu32
                    "; copy or export it again",
                    header_.records_at);
}

Result<std::size_t> LasPoints::read(std::span<Vec3> points) {
  if (is_cut_) return cut_off();
  const std::size_t record_bytes = header_.record_bytes;
  const std::uint64_t left = header_.points - points_read_;
  const auto wanted = static_cast<std::size_t>(
      std::min<std::uint64_t>({points.size(), piece_.size() / record_bytes, left}));
  if (wanted == 0) return std::size_t{0};
  const auto bytes = file_.read(std::span(piece_).first(wanted * record_bytes));
  if (!bytes) return bytes.error();
  const std::size_t count = *bytes / record_bytes;
  for (std::size_t i = 0; i < count; ++i)
    points[i] = header_.position(piece_.data() + i * record_bytes);
  offset_ += *bytes;
  points_read_ += count;
  is_cut_ = count < wanted;
  if (count == 0) return cut_off();
  return count;
}

Error LasPoints::cut_off() const {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, offset_,
                    "the file ends after %" PRIu64 " of %" PRIu64
                    " points; copy or export it again",
                    points_read_, header_.points);
}

}  // namespace planetree::tools
