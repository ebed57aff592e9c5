#include <bit>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

#include "tools/arrays/npy_array.h"
#include "tools/arrays/vtp_cloud.h"
#include "tools/values/coloured_cloud.h"

// A coloured cloud as a NumPy array and as a VTK file.
namespace planetree::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "rows are written in place");

std::vector<Column> coloured_columns(const std::string& property) {
  return {{"point", NumberType::kFloat64, {"x", "y", "z"}},
          {property, NumberType::kFloat64},
          {"colour", NumberType::kUint8, {"red", "green", "blue"}}};
}

}  // namespace

template <class Take>
Result<void> ColouredCloud::for_each_row_piece(const ColourScale& colours, const Take& take) {
  std::vector<std::byte> rows;
  return points_.for_each_piece([&](std::span<const PointRecord> records) {
    constexpr std::size_t kRowBytes = sizeof(PointRecord) + sizeof(Colour);
    rows.resize(records.size() * kRowBytes);
    std::byte* row = rows.data();
    for (const PointRecord& record : records) {
      const Colour colour = colours.colour(record.value);
      std::memcpy(row, &record, sizeof record);
      std::memcpy(row + sizeof record, colour.data(), sizeof colour);
      row += kRowBytes;
    }
    return take(std::span<const std::byte>(rows));
  });
}

Result<void> ColouredCloud::write_npy(const ColourScale& colours) {
  const std::string header = npy_header_text(coloured_columns(property_), points_.count());
  if (auto written = output_.write(std::as_bytes(std::span(header))); !written) return written;
  return for_each_row_piece(
      colours, [this](std::span<const std::byte> rows) { return output_.write(rows); });
}

Result<void> ColouredCloud::write_vtp(const ColourScale& colours) {
  VtpCloud cloud(coloured_columns(property_), "point", property_, directory_);
  const auto added = for_each_row_piece(
      colours, [&cloud](std::span<const std::byte> rows) { return cloud.add(rows); });
  if (!added) return added;
  const auto joined =
      triangles_.for_each_piece([&cloud](std::span<const TriangleRecord> records) -> Result<void> {
        for (const auto& [a, b, c] : records)
          if (const auto taken = cloud.add_triangle({a, b, c}); !taken) return taken;
        return {};
      });
  if (!joined) return joined;
  const auto written = cloud.write_to([this](std::string_view text) -> Result<bool> {
    const auto taken = output_.write(std::as_bytes(std::span(text)));
    return taken ? Result<bool>(true) : taken.error();
  });
  return written ? Result<void>() : written.error();
}

}  // namespace planetree::tools
