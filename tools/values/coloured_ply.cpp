#include <fmt/format.h>

#include <bit>
#include <span>
#include <vector>

#include "tools/values/coloured_cloud.h"

// A coloured cloud as a binary PLY.
namespace planetree::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "records are written in place");

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  const auto raw = std::as_bytes(std::span(&value, 1));
  bytes.insert(bytes.end(), raw.begin(), raw.end());
}

}  // namespace

Result<void> ColouredCloud::write_ply(const ColourScale& colours) {
  std::string header = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment {}\ncomment colours from {} to {}\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\n"
      "property float {}\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n",
      comment_, colours.lower(), colours.upper(), points_.count(), property_);
  if (triangles_.count() > 0)
    header += fmt::format("element face {}\nproperty list uchar uint vertex_indices\n",
                          triangles_.count());
  header += "end_header\n";
  if (auto written = output_.write(std::as_bytes(std::span(header))); !written) return written;
  std::vector<std::byte> bytes;
  const auto written = points_.for_each_piece([&](std::span<const PointRecord> records) {
    bytes.clear();
    for (const PointRecord& record : records) {
      append(bytes, record.x);
      append(bytes, record.y);
      append(bytes, record.z);
      append(bytes, static_cast<float>(record.value));
      append(bytes, colours.colour(record.value));
    }
    return output_.write(bytes);
  });
  if (!written) return written;
  return triangles_.for_each_piece([&](std::span<const TriangleRecord> records) {
    bytes.clear();
    for (const TriangleRecord& record : records) {
      append(bytes, std::uint8_t{3});
      append(bytes, record);
    }
    return output_.write(bytes);
  });
}

}  // namespace planetree::tools
