#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <vector>

#include "octree/builder/mask/mask_plan.h"
#include "octree/builder/mask/mask_tree.h"
#include "octree/geometry/cell_grid.h"
#include "octree/mask/mask_lookup.h"
#include "tests/octree/support/sample_tree.h"

/// Closed surfaces, their masks, and the decoded pages of the masks.
namespace planetree::octree {

/// The faces of a box, facing outward, each of 2 `side`^2 triangles.
Soup box(const Vec3& lower, const Vec3& upper, unsigned side = 1);
/// Tetrahedra in the unit cube with edges up to `edge`, of either orientation.
Soup grains(std::size_t count, double edge, std::uint64_t seed = 1);
Soup inside_out(Soup soup);
Soup translated(Soup soup, const Vec3& by);
Soup scaled(Soup soup, double factor);
Soup joined(std::initializer_list<Soup> soups);
Soup copies(const Soup& soup, std::size_t count);
/// `count` concentric spheres, with radii from 1 down in steps of 0.002.
Soup shells(std::size_t count);

/// The triangles of a closed surface, for tests that examine each of them.
class Surface {
 public:
  explicit Surface(std::vector<Triangle> triangles);
  explicit Surface(const SampleMesh& mesh);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  /// The winding number of a point perturbed by its infinitesimal step: crossings of a segment
  /// straight up, out of the box of all triangles.
  std::int64_t winding(const Point& point) const;
  bool holds(const Point& point) const;
  /// The triangles that touch a closed box, found in exact arithmetic.
  std::vector<Triangle> touching(const Point& lower, const Point& upper) const;

 private:
  struct Box {
    double lower[3], upper[3];
  };
  std::vector<Triangle> triangles_;
  std::vector<Box> boxes_;
  double top_ = 0;
};

/// Calls look(cell, entry) for every entry below the root, parents first.
void each_entry(const MaskTree& tree,
                const std::function<void(const GridCell&, std::uint32_t entry)>& look);

/// The mask of a watertight soup.
struct SampleMask {
  explicit SampleMask(const Soup& soup);

  SampleMesh mesh;
  Surface surface;
  MaskTree tree;
  CellGrid grid;
};

/// All pages of a mask, encoded and decoded again.
class MaskPages {
 public:
  MaskPages(const MaskTree& tree, std::uint32_t page_bytes, std::uint32_t first_page = 0,
            bool float64 = true);

  const MaskPlan& plan() const { return plan_; }
  std::uint32_t size() const { return static_cast<std::uint32_t>(frames_.size()); }
  const std::vector<std::byte>& raw(std::uint32_t page) const { return raw_[page]; }
  const SampleFrame& frame(std::uint32_t page) const { return frames_[page]; }
  /// Info of page `page`, counted within the mask.
  PageInfo info(std::uint32_t page) const;
  MaskInfo mask(const Point& lower) const;

  void withhold(std::uint32_t page, bool withheld = true) { withheld_[page] = withheld; }
  /// Pages accessed since the last call, by number within the mask.
  std::vector<std::uint32_t> take_queried();
  PageReader reader();
  /// A reader with `peek`: all pages but withheld ones are resident.
  PageReader resident_reader();

 private:
  const std::byte* page(std::uint32_t number);
  const std::byte* peek(std::uint32_t number) const;

  std::uint32_t first_page_;
  bool float64_;
  MaskPlan plan_;
  std::vector<std::vector<std::byte>> raw_;
  std::vector<SampleFrame> frames_;
  std::vector<bool> withheld_;
  std::vector<std::uint32_t> queried_;
};

inline bool same(const MaskBlocks& a, const MaskBlocks& b) {
  return a.count == b.count && a.slab == b.slab &&
         std::equal(a.links.begin(), a.links.begin() + a.count, b.links.begin()) &&
         std::equal(a.octants.begin(), a.octants.begin() + a.count, b.octants.begin());
}

/// The header of a decoded mask page.
inline const MaskHeader& header_of(const SampleFrame& frame) {
  return *reinterpret_cast<const MaskHeader*>(frame.data());
}

inline const std::byte* slot_of(const SampleFrame& frame, std::uint32_t slot) {
  return frame.data() + slot * kMaskSlotBytes;
}

inline bool is_node(const SampleFrame& frame, std::uint32_t slot) {
  const auto* bits = reinterpret_cast<const std::uint64_t*>(frame.data() + sizeof(MaskHeader));
  return (bits[slot / 64] >> slot % 64 & 1) != 0;
}

}  // namespace planetree::octree
