#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "octree/builder/mesh/stream/polygon_triangulator.h"
#include "tests/octree/support/polygon_shapes.h"

/// Splits polygons with whole coordinates: arbitrary ones, simple ones and outlines full of slits.
///
/// Contract: two triangles fewer than corners, of which every corner has a part; where ears are
/// cut, all triangles turn the way the polygon does; the sum of their areas is the polygon's. A
/// simple polygon is never called odd, and all its triangles turn its way, those of a fan too.
namespace planetree::octree {
namespace {

void expect(bool truth) {
  if (!truth) std::abort();
}

/// Random numbers from the input, and from its length where it ends.
class ByteSource {
 public:
  explicit ByteSource(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint64_t operator()() {
    ++drawn_;
    std::uint64_t value = drawn_ * 0x9e3779b97f4a7c15;
    if (bytes_.empty()) return value >> 17;
    value = bytes_[0];
    bytes_ = bytes_.subspan(1);
    if (bytes_.empty()) return value;
    value |= std::uint64_t{bytes_[0]} << 8;
    bytes_ = bytes_.subspan(1);
    return value;
  }
  [[nodiscard]] std::size_t left() const { return bytes_.size(); }

 private:
  std::span<const std::uint8_t> bytes_;
  std::uint64_t drawn_ = 0;
};

FlatPolygon arbitrary(ByteSource& bytes, std::int64_t range) {
  FlatPolygon polygon;
  while (bytes.left() >= 4 && polygon.size() < 400) {
    const auto span = static_cast<std::uint64_t>(range + 1);
    const auto u = static_cast<std::int64_t>(bytes() % span);
    polygon.push_back({u, static_cast<std::int64_t>(bytes() % span)});
  }
  return polygon;
}

void check(const PolygonTriangulator& split, const FlatPolygon& polygon, bool is_simple) {
  const std::int64_t whole = area_of(polygon);
  const auto side = [&](std::int64_t area) { return whole < 0 ? -area : area; };
  std::int64_t sum = 0;
  if (split.is_fan()) {
    for (std::size_t k = 2; k < polygon.size() && is_simple; ++k)
      expect(side(area_of(polygon[0], polygon[k - 1], polygon[k])) >= 0);
    return;
  }
  std::vector<bool> used(polygon.size());
  expect(split.triangles().size() == polygon.size() - 2);
  for (const CornerTriple& triangle : split.triangles()) {
    for (const std::uint32_t corner : triangle) used.at(corner) = true;
    const std::int64_t area =
        area_of(polygon[triangle[0]], polygon[triangle[1]], polygon[triangle[2]]);
    expect(side(area) >= 0);
    sum += area;
  }
  expect(sum == whole);
  for (const bool is_used : used) expect(is_used);
}

void run(ByteSource bytes) {
  const std::uint64_t choice = bytes();
  const auto kind = choice % 3;
  const std::int64_t range = choice / 3 % 2 == 0 ? 7 : 1000;
  const std::vector<Placement> placements = all_placements();
  const Placement& placement = placements[choice / 6 % placements.size()];
  const bool is_reversed = choice / 64 % 2 == 1;
  FlatPolygon polygon = kind == 0   ? arbitrary(bytes, range)
                        : kind == 1 ? random_simple(bytes, 4 + bytes.left() / 4 % 60, range)
                                    : cell_tree(bytes, 2 + bytes.left() / 2 % 60);
  if (is_reversed) std::reverse(polygon.begin(), polygon.end());
  if (polygon.size() < 4) return;
  PolygonTriangulator split, again;
  const std::vector<Vec3> corners = placed(polygon, placement);
  const PolygonFault fault = split.split(corners);
  expect(kind == 0 || fault == PolygonFault::kNone);
  check(split, polygon, kind != 0);
  expect(again.split(corners) == fault);
  expect(std::ranges::equal(again.triangles(), split.triangles()));
}

}  // namespace
}  // namespace planetree::octree

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  planetree::octree::run(planetree::octree::ByteSource({data, size}));
  return 0;
}
