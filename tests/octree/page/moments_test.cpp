#include "octree/page/moments.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include <gtest/gtest.h>

#include "octree/builder/tree/moment_sums.h"
#include "octree/geometry/angles.h"
#include "octree/geometry/certain_sum.h"
#include "octree/winding/multipole.h"
#include "tests/octree/support/sample_tree.h"

namespace planetree::octree {
namespace {

TEST(ShortFloat, RoundsUp) {
  for (const double value : {0.0, 1e-300, 0x1p-126, 1.0, 1.0000001, 0.999999, 3.14, 1e30}) {
    const ShortFloat packed = pack_short_above(value);
    EXPECT_GE(static_cast<double>(unpack_short(packed)), value);
    if (packed > kMinShortFloat) {
      EXPECT_LT(static_cast<double>(unpack_short(static_cast<ShortFloat>(packed - 1))), value);
    }
  }
  EXPECT_EQ(pack_short_above(0), kMinShortFloat);
  EXPECT_EQ(pack_short_above(1), 0x3f80);
  EXPECT_EQ(pack_short_above(1 + 0x1p-60), 0x3f80 + 0);
  EXPECT_EQ(pack_short_above(1 + 0x1p-20), 0x3f81);
  EXPECT_EQ(pack_short_above(1e39), kMaxShortFloat);
}

TEST(CertainSum, ErrorBoundCoversCancellation) {
  CertainSum sum;
  Noise noise(1);
  // Terms of widely different size that cancel: 2^-20 remains.
  std::vector<double> terms;
  for (int i = 0; i < 5000; ++i)
    terms.push_back(std::ldexp(noise.uniform(-1, 1), static_cast<int>(noise.bits() % 40)));
  sum.add(0x1p-20);
  for (const double term : terms) sum.add(term);
  for (const double term : terms) sum.add(-term);
  EXPECT_NEAR(sum.value(), 0x1p-20, sum.error());
  EXPECT_LT(sum.error(), 0x1p-40);
}

// Ten million tiny terms: a naive sum is wrong by about 2^-35, this one by its last bit.
TEST(CertainSum, StaysAccurateOverTenMillionTerms) {
  const double term = 1.0 / 3 * 0x1p-23;
  CertainSum sum;
  double naive = 0;
  for (int i = 0; i < 10'000'000; ++i) {
    sum.add(term);
    naive += term;
  }
  const long double exact = 10'000'000.0L * static_cast<long double>(term);
  EXPECT_LE(std::fabs(static_cast<double>(sum.value() - exact)), sum.error());
  EXPECT_LT(sum.error(), 0x1p-50);
  EXPECT_GT(std::fabs(static_cast<double>(naive - exact)), sum.error());
}

std::vector<Triangle> triangles_below(const SampleTree& sample, const WideChild& child) {
  std::vector<Triangle> found;
  for (std::uint32_t i = child.begin; i < child.end; ++i)
    found.push_back(sample.mesh.corners(sample.keys[i].position));
  return found;
}

std::vector<std::pair<const char*, Soup>> open_soups() {
  return {{"sheet", height_field(20)}, {"scattered", scattered(700, 0.2)}, {"sphere", sphere(4)}};
}

// The error of every child's share is within its stated bound, near and far.
TEST(Multipoles, ErrorBoundsHold) {
  for (const auto& [name, soup] : open_soups()) {
    const SampleTree sample = build_sample(soup, 65536, 0, true);
    SamplePages pages(sample);
    Noise noise(3);
    int certain = 0;
    double worst = 0;
    for (std::size_t i = 0; i < sample.tree.nodes.size(); ++i) {
      const WideNode& wide = sample.tree.nodes[i];
      const Node& node =
          *reinterpret_cast<const Node*>(pages.node_record(sample, sample.plan.node_links[i]));
      for (int k = 0; k < 12; ++k) {
        const double reach = std::ldexp(1.0, -static_cast<int>(noise.bits() % 6));
        const Vec3 by = noise.point(-2 * reach, 2 * reach);
        const auto& box = wide.box;
        const Point query = sample.centre + Point(static_cast<double>(box.lower[0]) + by.x,
                                                  static_cast<double>(box.lower[1]) + by.y,
                                                  static_cast<double>(box.lower[2]) + by.z);
        std::array<Multipoles::Share, kFanOut> shares;
        Multipoles(query, tree_info(sample)).shares(node, shares);
        for (unsigned child = 0; child < wide.child_count; ++child) {
          if (!(shares[child].error < 1)) continue;
          double exact = 0;
          for (const Triangle& triangle : triangles_below(sample, wide.children[child]))
            exact += winding_share(query, triangle).value;
          const double off = std::fabs(shares[child].value - exact);
          EXPECT_LE(off, shares[child].error + 1e-12) << name;
          worst = std::max(worst, off / shares[child].error);
          ++certain;
        }
      }
    }
    EXPECT_GT(certain, 500) << name;
    EXPECT_GT(worst, 0.05) << name;  // the bound is not needlessly loose
  }
}

/// A copy of a node in a frame and of the moments behind it, to be changed.
struct alignas(kSlotBytes) NodeWithMoments {
  explicit NodeWithMoments(const std::byte* record)
      : node(*reinterpret_cast<const Node*>(record)),
        moments(NodeMoments::of(*reinterpret_cast<const Node*>(record))) {}

  Node node;
  NodeMoments moments;
};

TEST(Multipoles, AreUnknownInsideTheBox) {
  const SampleTree sample = build_sample(height_field(8), 65536, 0, true);
  SamplePages pages(sample);
  const Node& root =
      *reinterpret_cast<const Node*>(pages.node_record(sample, sample.plan.node_links[0]));
  std::array<Multipoles::Share, kFanOut> shares;
  Multipoles(sample.mesh.corners(0)[0], tree_info(sample)).shares(root, shares);
  EXPECT_TRUE(std::any_of(shares.begin(), shares.begin() + root.child_count,
                          [](const auto& share) { return share.error == Multipoles::kUnknown; }));
}

// Boxes of a forged page are finite, but the sum of their sides need not be.
TEST(Multipoles, AreUnknownWhereTheMiddleOfABoxOverflows) {
  const SampleTree sample = build_sample(height_field(8), 65536, 0, true);
  SamplePages pages(sample);
  const std::byte* root = pages.node_record(sample, sample.plan.node_links[0]);
  NodeWithMoments copy(root);
  for (unsigned axis = 0; axis < 3; ++axis) {
    copy.node.box.lower[axis] = 3e38F;
    copy.node.box.upper[axis] = 3.2e38F;
    copy.node.step[axis] = box_step(3e38F, 3.2e38F);
  }
  std::array<Multipoles::Share, kFanOut> shares;
  Multipoles(Point(0, 0, 9), tree_info(sample)).shares(copy.node, shares);
  EXPECT_EQ(shares[0].error, Multipoles::kUnknown);
  EXPECT_EQ(shares[0].value, 0);
}

TEST(Multipoles, AreUnknownWhereTheMomentsAre) {
  const SampleTree sample = build_sample(height_field(8), 65536, 0, true);
  SamplePages pages(sample);
  const std::byte* root = pages.node_record(sample, sample.plan.node_links[0]);
  NodeWithMoments copy(root);
  const Multipoles multipoles(Point(0, 0, 9), tree_info(sample));
  std::array<Multipoles::Share, kFanOut> shares;
  multipoles.shares(copy.node, shares);
  EXPECT_LT(shares[0].error, Multipoles::kUnknown);
  EXPECT_LT(shares[1].error, Multipoles::kUnknown);
  copy.moments.area[0] = copy.moments.second[1] = kMaxShortFloat;
  multipoles.shares(copy.node, shares);
  EXPECT_EQ(shares[0].error, Multipoles::kUnknown);
  EXPECT_EQ(shares[1].error, Multipoles::kUnknown);
}

// Moments come back as encoded, independent of the page they are in.
TEST(Moments, RoundTripThroughAPage) {
  const SampleTree sample = build_sample(scattered(900, 0.1), 4096, 0, true);
  SamplePages pages(sample);
  ASSERT_GT(pages.size(), 4u);
  for (std::size_t i = 0; i < sample.tree.nodes.size(); ++i) {
    const Node& node =
        *reinterpret_cast<const Node*>(pages.node_record(sample, sample.plan.node_links[i]));
    EXPECT_EQ(std::memcmp(&NodeMoments::of(node), &sample.tree.moments[i], sizeof(NodeMoments)), 0);
  }
}

}  // namespace
}  // namespace planetree::octree
