// Checks "Mask" and "Mask page" in the samples, as the independent reader decodes them, against
// sums of solid angles of the surface and its caps.

#include "tests/golden/spec_mask.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"
#include "tests/golden/spec_vector.h"

namespace planetree::golden {
namespace {

double volume(const SpecPoint& a, const SpecPoint& b, const SpecPoint& c) {
  return dot(a, cross(b, c));
}

class SpecMasks : public testing::TestWithParam<Sample> {
 protected:
  SpecMasks()
      : file_(read_file(GetParam().ptree_path())),
        mask_(file_),
        tree_(file_),
        triangles_(tree_.triangles(tree_.root_link())) {
    if (!file_.header().open()) return;
    caps_.emplace_back(file_, SpecTree::Of::kCaps);
    const std::vector<SpecTriangle> caps = caps_[0].triangles(caps_[0].root_link());
    triangles_.insert(triangles_.end(), caps.begin(), caps.end());
  }

  // The winding number of the closed surface, or nothing if the point is so close to it that
  // rounding decides.
  std::optional<int> winding(const SpecPoint& point) const {
    const double number = winding_number(triangles_, point);
    if (std::fabs(number - std::round(number)) > 1e-6 || tree_.nearest(point).distance < 1e-9 ||
        (!caps_.empty() && caps_[0].nearest(point).distance < 1e-9))
      return std::nullopt;
    return static_cast<int>(std::round(number));
  }

  SpecPoint within(const SpecCell& cell, double x, double y, double z) const {
    const SpecPoint lower = mask_.corner(cell, 0), upper = mask_.corner(cell, 7);
    return {lower[0] + x * (upper[0] - lower[0]), lower[1] + y * (upper[1] - lower[1]),
            lower[2] + z * (upper[2] - lower[2])};
  }

  SpecFile file_;
  SpecMask mask_;
  SpecTree tree_;
  std::vector<SpecTree> caps_;           // one, or none
  std::vector<SpecTriangle> triangles_;  // the caps last
};

INSTANTIATE_TEST_SUITE_P(All, SpecMasks, testing::ValuesIn(samples()), sample_name);

// Plain leaves occur where many blocks meet: see spec_lists_test.cpp.
TEST(SpecMaskSamples, HaveRecordsOfAllKindsButPlainLeaves) {
  std::set<unsigned> kinds;
  unsigned inverted = 0;
  for (const Sample& sample : samples())
    SpecMask(SpecFile(read_file(sample.ptree_path())))
        .each_grey([&](const SpecCell&, const SpecMaskRecord& record) {
          kinds.insert(record.kind);
          inverted |= record.inverted;
        });
  EXPECT_EQ(kinds, (std::set<unsigned>{0, 1, 3, 4, 5}));
  EXPECT_NE(inverted, 0u);
}

TEST_P(SpecMasks, RecordsFormOneTree) {
  EXPECT_GT(file_.header().mask_pages, 0u);
  std::size_t records = 0, visited = 0;
  unsigned levels = 0;
  for (const SpecMaskPage& page : mask_.pages()) records += page.records.size();
  std::set<const SpecMaskRecord*> seen;
  mask_.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
    EXPECT_TRUE(seen.insert(&record).second) << "linked twice";
    levels = std::max(levels, cell.level);
    ++visited;
  });
  EXPECT_EQ(visited, records);
  EXPECT_EQ(file_.header().mask_cells, records);
  EXPECT_EQ(file_.header().mask_levels, levels);
}

// Bits from the coarsest level down: z, y, x of each level.
std::uint64_t octcode(const SpecCell& cell) {
  std::uint64_t morton = 0;
  for (unsigned level = cell.level; level-- > 0;)
    for (const unsigned axis : {2u, 1u, 0u}) morton = 2 * morton + (cell.at[axis] >> level & 1);
  return std::uint64_t{cell.level} << 59 | morton << (3 * (19 - cell.level) + 2);
}

TEST_P(SpecMasks, PagesHaveOneParentAndTheKeysOfTheirFirstFamilies) {
  std::map<std::size_t, std::size_t> parent_of;
  std::map<std::size_t, std::uint64_t> key_of = {{0, 0}};
  std::map<const SpecMaskRecord*, std::size_t> page_of;
  for (std::size_t k = 0; k < mask_.pages().size(); ++k)
    for (const SpecMaskRecord& record : mask_.pages()[k].records) page_of[&record] = k;
  mask_.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
    if (record.kind != 1) return;
    const auto [page, first] = record.family;
    EXPECT_GT(page, page_of[&record]);
    EXPECT_LT(first, mask_.pages().at(page).root_count);
    EXPECT_EQ(parent_of.emplace(page, page_of[&record]).first->second, page_of[&record]);
    const auto key = key_of.emplace(page, octcode(cell)).first;
    key->second = std::min(key->second, octcode(cell));
  });
  EXPECT_EQ(parent_of.size(), mask_.pages().size() - 1);
  for (std::size_t k = 0; k < mask_.pages().size(); ++k) {
    EXPECT_EQ(mask_.pages()[k].octcode, key_of[k]);
    EXPECT_EQ(mask_.pages()[k].ordinal, 0u);
  }
}

TEST_P(SpecMasks, ColoursAreWindingNumbers) {
  std::size_t certain = 0;
  mask_.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
    if (!record.is_node()) return;
    for (unsigned i = 0; i < 8; ++i) {
      if ((record.grey >> i & 1) != 0) continue;
      const auto number = winding(within(cell.octant(i), 0.5, 0.5, 0.5));
      ASSERT_TRUE(number);
      EXPECT_EQ(*number > 0, (record.black >> i & 1) != 0);
      EXPECT_EQ(*number < 0, (record.inverted >> i & 1) != 0);
      ++certain;
    }
  });
  EXPECT_EQ(certain == 0, triangles_.size() <= 64);
}

TEST_P(SpecMasks, CornersAreWindingNumbers) {
  std::size_t certain = 0;
  mask_.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
    if (!record.has_corners()) return;
    for (unsigned i = 0; i < 8; ++i) {
      const auto number = winding(mask_.corner(cell, i));
      if (!number) continue;
      EXPECT_EQ(record.corners[i], *number);
      ++certain;
    }
  });
  EXPECT_GT(certain, 0u);
}

// Signs are computed in double. Points so close to a plane that a sign may be wrong are skipped.
TEST_P(SpecMasks, SpecialCellsHaveTwoWindingNumbers) {
  mask_.each_grey([&](const SpecCell& cell, const SpecMaskRecord& record) {
    if (record.kind != 4) return;
    for (int i = 0; i < 27; ++i) {
      const SpecPoint point =
          within(cell, 0.03 + 0.45 * (i % 3), 0.05 + 0.44 * (i / 3 % 3), 0.02 + 0.47 * (i / 9));
      const auto number = winding(point);
      if (!number) continue;
      bool beyond = false;
      for (const SpecPlane& plane : record.planes)
        beyond = beyond || volume(plane[1] - plane[0], plane[2] - plane[0], point - plane[0]) > 0;
      EXPECT_EQ(*number, beyond ? record.beyond : record.behind);
    }
  });
}

}  // namespace
}  // namespace planetree::golden
