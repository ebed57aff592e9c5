#include "tests/octree/support/sample_mask.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "octree/builder/mask/mask_encoder.h"
#include "octree/geometry/predicates.h"
#include "octree/page/page_decoder.h"
#include "tests/octree/support/exact_overlap.h"

namespace planetree::octree {
namespace {

// Point `i` of `side` divisions between `from` and `to`. The result is the same bits in every call.
double part(double from, double to, unsigned i, unsigned side) {
  return i == side ? to : from + (to - from) * i / side;
}

// A face of a box across `axis` at `at`, with its normal in the positive direction.
void add_face(const Vec3& l, const Vec3& u, unsigned axis, double at, unsigned side, Soup& soup) {
  const double lower[] = {l.x, l.y, l.z}, upper[] = {u.x, u.y, u.z};
  const unsigned j = (axis + 1) % 3, k = (axis + 2) % 3;
  const auto index = [&](unsigned m, unsigned n) {
    double p[3];
    p[axis] = at;
    p[j] = part(lower[j], upper[j], m, side);
    p[k] = part(lower[k], upper[k], n, side);
    return Vec3{p[0], p[1], p[2]};
  };
  for (unsigned m = 0; m < side; ++m)
    for (unsigned n = 0; n < side; ++n) {
      soup.push_back({index(m, n), index(m + 1, n), index(m + 1, n + 1)});
      soup.push_back({index(m, n), index(m + 1, n + 1), index(m, n + 1)});
    }
}

}  // namespace

Soup box(const Vec3& l, const Vec3& u, unsigned side) {
  Soup low, high;
  const double lower[] = {l.x, l.y, l.z}, upper[] = {u.x, u.y, u.z};
  for (unsigned axis = 0; axis < 3; ++axis) {
    add_face(l, u, axis, lower[axis], side, low);
    add_face(l, u, axis, upper[axis], side, high);
  }
  return joined({inside_out(low), high});
}

Soup grains(std::size_t count, double edge, std::uint64_t seed) {
  Noise noise(seed);
  Soup soup;
  for (std::size_t i = 0; i < count; ++i) {
    const Vec3 at = noise.point(0, 1);
    std::array<Vec3, 4> p;
    for (Vec3& corner : p) {
      const Vec3 from = noise.point(0, edge);
      corner = {at.x + from.x / 2, at.y + from.y / 2, at.z + from.z / 2};
    }
    for (const auto& [a, b, c] : {std::array{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
      soup.push_back({p[static_cast<std::size_t>(a)], p[static_cast<std::size_t>(b)],
                      p[static_cast<std::size_t>(c)]});
  }
  return soup;
}

Soup inside_out(Soup soup) {
  for (auto& triangle : soup) std::swap(triangle[1], triangle[2]);
  return soup;
}

Soup translated(Soup soup, const Vec3& by) {
  for (auto& triangle : soup)
    for (Vec3& p : triangle) p = {p.x + by.x, p.y + by.y, p.z + by.z};
  return soup;
}

Soup scaled(Soup soup, double factor) {
  for (auto& triangle : soup)
    for (Vec3& p : triangle) p = {p.x * factor, p.y * factor, p.z * factor};
  return soup;
}

Soup joined(std::initializer_list<Soup> soups) {
  Soup all;
  for (const Soup& soup : soups) all.insert(all.end(), soup.begin(), soup.end());
  return all;
}

Soup copies(const Soup& soup, std::size_t count) {
  Soup all;
  for (std::size_t i = 0; i < count; ++i) all.insert(all.end(), soup.begin(), soup.end());
  return all;
}

Soup shells(std::size_t count) {
  Soup all;
  for (std::size_t i = 0; i < count; ++i) {
    const Soup one = scaled(sphere(2), 1 - 0.002 * static_cast<double>(i));
    all.insert(all.end(), one.begin(), one.end());
  }
  return all;
}

Surface::Surface(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  for (const auto& [a, b, c] : triangles_) {
    Box box{};
    for (unsigned axis = 0; axis < 3; ++axis) {
      box.lower[axis] = std::min({a[axis], b[axis], c[axis]});
      box.upper[axis] = std::max({a[axis], b[axis], c[axis]});
    }
    top_ = boxes_.empty() ? box.upper[2] : std::max(top_, box.upper[2]);
    boxes_.push_back(box);
  }
}

Surface::Surface(const SampleMesh& mesh)
    : Surface([&] {
        std::vector<Triangle> triangles;
        for (std::uint32_t i = 0; i < mesh.size(); ++i) triangles.push_back(mesh.corners(i));
        return triangles;
      }()) {}

std::int64_t Surface::winding(const Point& point) const {
  const double x = point.x(), y = point.y(), z = point.z();
  if (z > top_) return 0;
  const Point outside(x, y, top_ + 1 + 0x1p-40 * std::fabs(top_));
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Box& box = boxes_[i];
    if (box.lower[0] <= x && x <= box.upper[0] && box.lower[1] <= y && y <= box.upper[1])
      sum += crossing({point, outside}, triangles_[i]);
  }
  return sum;
}

bool Surface::holds(const Point& point) const { return !touching(point, point).empty(); }

std::vector<Triangle> Surface::touching(const Point& lower, const Point& upper) const {
  std::vector<Triangle> found;
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Box& box = boxes_[i];
    bool near = true;
    for (unsigned axis = 0; axis < 3; ++axis)
      near = near && box.lower[axis] <= upper[axis] && box.upper[axis] >= lower[axis];
    if (near && exactly_touches(triangles_[i], lower, upper)) found.push_back(triangles_[i]);
  }
  return found;
}

void each_entry(const MaskTree& tree,
                const std::function<void(const GridCell&, std::uint32_t)>& look) {
  std::vector<std::pair<GridCell, std::uint32_t>> queue = {{GridCell{}, 0}};
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const auto [cell, at] = queue[i];
    look(cell, at);
    const MaskEntry& entry = tree.entries[at];
    if (entry.kind != MaskEntry::Kind::kNode) continue;
    std::uint32_t child = entry.first;
    for (unsigned octant = 0; octant < 8; ++octant)
      if ((entry.grey >> octant & 1) != 0) queue.emplace_back(cell.child(octant), child++);
  }
}

SampleMask::SampleMask(const Soup& soup)
    : mesh(store(soup)), surface(mesh), tree(mask_of(mesh)), grid(mesh.frame.lower()) {}

MaskPages::MaskPages(const MaskTree& tree, std::uint32_t page_bytes, std::uint32_t first_page,
                     bool float64)
    : first_page_(first_page), float64_(float64), plan_(plan_mask(tree, page_bytes)) {
  withheld_.resize(plan_.pages.size());
  const MaskEncoder encoder(tree, plan_, first_page, float64);
  for (std::uint32_t page = 0; page < plan_.pages.size(); ++page) {
    raw_.push_back(encoder.encode(page).bytes);
    frames_.emplace_back(page_bytes);
    const auto decoded = decode_mask_page(raw_[page], info(page), frames_[page].bytes());
    if (decoded) continue;
    std::fprintf(stderr, "sample: %s\n", decoded.error().text);
    std::abort();
  }
}

PageInfo MaskPages::info(std::uint32_t page) const {
  PageInfo info;
  info.page_bytes = plan_.page_bytes;
  info.first_page = info.tree_pages = first_page_;
  info.page_count = static_cast<std::uint32_t>(plan_.pages.size());
  info.shape.float64 = float64_;
  info.page_number = first_page_ + page;
  info.octcode = plan_.pages[page].octcode;
  return info;
}

MaskInfo MaskPages::mask(const Point& lower) const {
  return {plan_.page_bytes, first_page_, size(), lower};
}

std::vector<std::uint32_t> MaskPages::take_queried() { return std::exchange(queried_, {}); }

const std::byte* MaskPages::page(std::uint32_t number) {
  queried_.push_back(number - first_page_);
  return peek(number);
}

const std::byte* MaskPages::peek(std::uint32_t number) const {
  const std::uint32_t within = number - first_page_;
  return within >= size() || withheld_[within] ? nullptr : frames_[within].data();
}

PageReader MaskPages::reader() {
  return {this, [](void* context, std::uint32_t number) noexcept {
            return static_cast<MaskPages*>(context)->page(number);
          }};
}

PageReader MaskPages::resident_reader() {
  PageReader reader = this->reader();
  reader.peek = [](void* context, std::uint32_t number) noexcept {
    return static_cast<const MaskPages*>(context)->peek(number);
  };
  return reader;
}

}  // namespace planetree::octree
