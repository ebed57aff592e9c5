#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "octree/field/coarse_field.h"
#include "octree/field/field_page.h"

/// Decodes arbitrary bytes as the field page of a small grid and asks the field. Input by offset:
///
///   0  points along x, y and z, less 2, in 4 bits each; 2 bytes, little-endian
///   2  the page
///
/// The page number and key are set to the expected ones, because few inputs would pass that
/// comparison.
namespace planetree::octree {
namespace {

constexpr std::uint32_t kPage = 3;

void ask(const CoarseField& field) {
  for (const double x : {-1e300, -1.0, 0.0, 0.3, 0.7, 4.0, 1e30})
    for (const double y : {-2.0, 0.1, 0.9})
      for (const double z : {-1e9, 0.5, 3.0}) {
        const FieldBounds bounds = field.bounds(Point(x, y, z));
        if (!(bounds.lower >= 0) || std::isnan(bounds.upper) || std::isnan(bounds.point.sum()))
          std::abort();
        if (std::isnan(field.estimate(Point(x, y, z)).upper)) std::abort();
      }
}

void run(std::span<const std::byte> bytes) {
  if (bytes.size() < 2 + sizeof(FieldPageHead)) return;
  const unsigned sizes = static_cast<unsigned>(bytes[0]) | static_cast<unsigned>(bytes[1]) << 8;
  FieldShape shape;
  for (unsigned axis = 0; axis < 3; ++axis) shape.size[axis] = 2 + (sizes >> (4 * axis) & 15);
  shape.step = 0.125;
  shape.quantum = 0x1p-16;
  std::vector<std::byte> raw(bytes.begin() + 2, bytes.end());
  FieldPageHead head{};
  std::memcpy(&head, raw.data(), sizeof head);
  head.page_number = kPage;
  head.ordinal = 0;
  head.octcode = 0;
  std::memcpy(raw.data(), &head, sizeof head);
  PageInfo info;
  info.first_page = info.page_number = kPage;
  info.page_count = 1;
  std::vector<FieldPoint> points(shape.count());
  if (!decode_field_page(raw, info, points)) return;
  for (const bool has_strays : {false, true}) {
    CoarseField field;
    field.fill(shape, points, has_strays);
    ask(field);
  }
}

}  // namespace
}  // namespace planetree::octree

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  planetree::octree::run({reinterpret_cast<const std::byte*>(data), size});
  return 0;
}
