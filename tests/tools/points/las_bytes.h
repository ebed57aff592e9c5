#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

/// Writes LAS files for tests, from the specification alone.
namespace planetree::tools {

inline constexpr std::uint64_t kTrueCount = std::numeric_limits<std::uint64_t>::max();

/// What a LAS file has. Counts are those of its points unless another is given.
struct LasFile {
  int minor = 2;
  int format = 0;
  std::vector<std::array<std::int32_t, 3>> points;
  std::array<double, 3> scale = {0.01, 0.01, 0.01};
  std::array<double, 3> offset = {};
  std::size_t extra_bytes = 0;                             ///< of each record
  std::size_t header_extra_bytes = 0;                      ///< behind the fields of the header
  std::vector<std::pair<std::string, std::string>> notes;  ///< user and content
  std::size_t gap_bytes = 0;                               ///< in front of the points
  std::string tail;                                        ///< behind the points
  std::uint64_t short_count = kTrueCount, long_count = kTrueCount;
  bool withholds = false;  ///< flags every second point as withheld
};

template <class Number>
void put(std::string& bytes, std::size_t at, Number number) {
  std::memcpy(bytes.data() + at, &number, sizeof number);
}

inline std::size_t las_header_bytes(int minor) {
  return minor == 4 ? 375u : minor == 3 ? 235u : 227u;
}
inline std::size_t las_record_bytes(int format) {
  constexpr std::size_t kBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
  return kBytes[format];
}

inline std::string las_record(const LasFile& file, std::size_t i) {
  // Attributes are not zero, so that none is taken for a coordinate.
  std::string record(las_record_bytes(file.format) + file.extra_bytes, '\x5a');
  for (std::size_t axis = 0; axis < 3; ++axis) put(record, 4 * axis, file.points[i][axis]);
  const bool withheld = file.withholds && i % 2 == 1;
  if (file.format <= 5)
    record[15] = static_cast<char>(withheld ? 0x82 : 0x02);
  else
    record[15] = static_cast<char>(withheld ? 0x04 : 0x00);
  return record;
}

inline std::string las_bytes(const LasFile& file) {
  std::string bytes(las_header_bytes(file.minor), '\0');
  put(bytes, 0, std::array<char, 4>{'L', 'A', 'S', 'F'});
  put(bytes, 24, std::uint8_t{1});
  put(bytes, 25, static_cast<std::uint8_t>(file.minor));
  put(bytes, 94, static_cast<std::uint16_t>(bytes.size() + file.header_extra_bytes));
  put(bytes, 100, static_cast<std::uint32_t>(file.notes.size()));
  put(bytes, 104, static_cast<std::uint8_t>(file.format));
  put(bytes, 105, static_cast<std::uint16_t>(las_record_bytes(file.format) + file.extra_bytes));
  const std::uint64_t count = file.points.size();
  put(bytes, 107,
      static_cast<std::uint32_t>(file.short_count == kTrueCount ? count : file.short_count));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    put(bytes, 131 + 8 * axis, file.scale[axis]);
    put(bytes, 155 + 8 * axis, file.offset[axis]);
  }
  if (file.minor == 4) put(bytes, 247, file.long_count == kTrueCount ? count : file.long_count);
  bytes += std::string(file.header_extra_bytes, '\x33');
  for (const auto& [user, content] : file.notes) {
    std::string note(54, '\0');
    note.replace(2, user.size(), user);
    put(note, 20, static_cast<std::uint16_t>(content.size()));
    bytes += note + content;
  }
  bytes += std::string(file.gap_bytes, '\x44');
  put(bytes, 96, static_cast<std::uint32_t>(bytes.size()));
  for (std::size_t i = 0; i < file.points.size(); ++i) bytes += las_record(file, i);
  return bytes + file.tail;
}

}  // namespace planetree::tools
