#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "planetree/error.h"
#include "planetree/types.h"

namespace planetree::tools {

/// The header of a LAS file: where its point records are, and how their integers become positions.
///
/// source  ASPRS, LAS Specification 1.4 - R15; the fields of 1.0 to 1.3 are at the same bytes
struct LasHeader {
  static constexpr std::size_t kMaxBytes = 375;  ///< of the fields that are read

  std::uint16_t bytes = 0;            ///< length of the header
  std::uint32_t records_at = 0;       ///< byte of the first point record
  std::uint32_t notes = 0;            ///< number of variable length records between the two
  std::uint16_t record_bytes = 0;     ///< length of a point record
  std::uint64_t points = 0;           ///< number of point records
  std::array<double, 3> scale = {};   ///< of x, y and z; finite, not 0
  std::array<double, 3> offset = {};  ///< of x, y and z; finite

  /// The position in a record: integer * scale + offset, rounded twice.
  [[nodiscard]] Vec3 position(const std::byte* record) const noexcept;
};

/// Whether a file begins as a LAS or LAZ file does.
[[nodiscard]] bool is_las(std::string_view front) noexcept;

/// What a message says of points that LASzip has compressed, as in every LAZ file.
[[nodiscard]] Error compressed_las();

/// Reads a header and checks every field that is used.
///
/// front   the first LasHeader::kMaxBytes bytes of the file, or all of it
/// errors  kBadInput, with the byte of the field: cut off, another version, a field out of range,
///         or points that are compressed
Result<LasHeader> parse_las_header(std::string_view front);

}  // namespace planetree::tools
