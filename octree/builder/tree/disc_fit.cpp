#include "octree/builder/tree/disc_fit.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "octree/geometry/strict_math.h"
#include "octree/traversal/bounds.h"

namespace planetree::octree {
namespace {

constexpr std::uint32_t kMaxTightTriangles = 1 << 16;
// Larger subtrees take their normal from about this many faces.
constexpr std::uint32_t kNormalFaces = 512;

// The extent of points along a decoded normal and across it.
class DiscExtent {
 public:
  DiscExtent(const FloatBox& box, const std::array<float, 3>& normal) {
    const std::array<float, 3> centre = box.centre();
    centre_ = Point(centre[0], centre[1], centre[2]);
    normal_ = Point(normal[0], normal[1], normal[2]);
  }

  void add(const Point& point) {
    const Point from = point - centre_;
    const double height = from.dot(normal_);
    lower_ = std::min(lower_, height);
    upper_ = std::max(upper_, height);
    radius2_ = std::max(radius2_, from.cross(normal_).squaredNorm());
  }

  // Rounds outward, with the slack that evaluation in float needs.
  void pack(const FloatBox& box, PackedChild& packed) const {
    const double step = box.plane_step();
    // Of a point there is nothing to say, and in a box as large as those of far strays no unit.
    if (!(step > 0) || !std::isfinite(step)) return;
    const double slack = kDiscOffsetSlack * 32000 * step;
    packed.slab_lower = static_cast<std::int16_t>(
        std::clamp(std::floor((lower_ - slack) / step), -32767.0, 32767.0));
    packed.slab_upper = static_cast<std::int16_t>(
        std::clamp(std::ceil((upper_ + slack) / step), -32767.0, 32767.0));
    // The normal's length is 1 only to a few 2^-24; the slack covers that too.
    packed.radius = static_cast<std::uint16_t>(
        std::clamp(std::ceil((std::sqrt(radius2_) + slack) / step), 0.0, 65535.0));
  }

 private:
  Point centre_, normal_;
  double lower_ = std::numeric_limits<double>::infinity();
  double upper_ = -std::numeric_limits<double>::infinity();
  double radius2_ = 0;
};

class DiscFitter {
 public:
  DiscFitter(const Triangles& mesh, const ChunkVertices& vertices, const Point& centre,
             const std::vector<MortonKey>& keys, const WideTree& tree)
      : mesh_(mesh), vertices_(vertices), centre_(centre), keys_(keys), tree_(tree) {}

  void fit(WideChild& child) const {
    const Point normal = normal_of(area_below(child));
    if (child.count() > kMaxTightTriangles)
      return fit_disc(child, normal, boxes_below(tree_, tree_.nodes[child.index]));
    child.packed.normal = pack_normal(normal.x(), normal.y(), normal.z());
    DiscExtent extent(child.box, unpack_normal(child.packed.normal));
    for_each_block(child, [&](std::uint32_t block) {
      for (const std::uint32_t vertex : vertices_.of_block(block))
        extent.add(vertices_[vertex] - centre_);
    });
    extent.pack(child.box, child.packed);
  }

 private:
  // Blocks are in the order of their triangles.
  template <class Look>
  void for_each_block(const WideChild& child, const Look& look) const {
    const auto first = std::partition_point(
        tree_.blocks.begin(), tree_.blocks.end(),
        [&child](const WideBlock& block) { return block.begin < child.begin; });
    for (auto block = first; block != tree_.blocks.end() && block->begin < child.end; ++block)
      look(static_cast<std::uint32_t>(block - tree_.blocks.begin()));
  }

  Point area_below(const WideChild& child) const {
    const std::uint32_t stride = 1 + child.count() / kNormalFaces;
    Point sum = Point::Zero();
    for (std::uint32_t i = child.begin; i < child.end; i += stride)
      sum += area_vector(mesh_.corners(keys_[i].position));
    return sum;
  }

  const Triangles& mesh_;
  const ChunkVertices& vertices_;
  const Point& centre_;
  const std::vector<MortonKey>& keys_;
  const WideTree& tree_;
};

}  // namespace

Point area_vector(const Triangle& triangle) {
  return (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
}

Point normal_of(const Point& area) {
  const double length = area.norm();
  return length > 0 ? Point(area / length) : Point(0, 0, 1);
}

void fit_disc(WideChild& child, const Point& normal, const std::vector<FloatBox>& boxes) {
  child.packed.normal = pack_normal(normal.x(), normal.y(), normal.z());
  DiscExtent extent(child.box, unpack_normal(child.packed.normal));
  for (const FloatBox& box : boxes)
    for (unsigned corner = 0; corner < 8; ++corner)
      extent.add(Point(corner & 1 ? box.upper[0] : box.lower[0],
                       corner & 2 ? box.upper[1] : box.lower[1],
                       corner & 4 ? box.upper[2] : box.lower[2]));
  extent.pack(child.box, child.packed);
}

std::vector<FloatBox> boxes_below(const WideTree& tree, const WideNode& node) {
  std::vector<FloatBox> boxes;
  for (unsigned i = 0; i < node.child_count; ++i) {
    const WideChild& child = node.children[i];
    if (child.block) {
      boxes.push_back(child.box);
      continue;
    }
    const WideNode& below = tree.nodes[child.index];
    for (unsigned j = 0; j < below.child_count; ++j) boxes.push_back(below.children[j].box);
  }
  return boxes;
}

void fit_discs(const Triangles& mesh, const ChunkVertices& vertices, const Point& centre,
               const std::vector<MortonKey>& keys, WideTree& tree) {
  const DiscFitter fitter(mesh, vertices, centre, keys, tree);
  for (WideNode& node : tree.nodes)
    for (unsigned child = 0; child < node.child_count; ++child) fitter.fit(node.children[child]);
}

}  // namespace planetree::octree
