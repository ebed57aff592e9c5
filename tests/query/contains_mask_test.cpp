#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "planetree/probe.h"
#include "query/answer/side.h"
#include "query/model_state.h"
#include "query/serve/page_accessor.h"
#include "tests/octree/support/sample_mask.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file/file_image.h"

// Sides of models with a mask: the work it saves, and that no answer depends on it.
namespace planetree::query {
namespace {

using storage::FileImage;

/// Points anywhere in the box, on vertices, and on faces of cells.
std::vector<Vec3> points_about(const SampleModel& sample, std::size_t count) {
  const octree::SampleMesh& mesh = sample.sample().mesh;
  const double unscale = std::ldexp(1.0, -mesh.frame.scale_exponent);
  octree::Noise noise(4);
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < count; ++i) {
    octree::Point point;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const double lower = mesh.frame.lower()[axis], edge = mesh.frame.upper()[axis] - lower;
      double offset = noise.uniform(-0.01, 1.01) * edge;
      if (i % 3 == 1) offset = std::floor(offset * 32) / 32;
      point[axis] = lower + offset;
    }
    if (i % 3 == 2) point = mesh.corners(noise.bits() % mesh.size())[noise.bits() % 3];
    points.push_back({point.x() * unscale, point.y() * unscale, point.z() * unscale});
  }
  return points;
}

/// An open model, queried below the level of Probe so that work can be counted.
class CountedSides {
 public:
  explicit CountedSides(const SampleModel& sample)
      : state_(open(sample)), reader_(*state_->claim_reader()) {}

  SideResult side(const Vec3& query, octree::TraversalStats& work) {
    const octree::Point point = state_->geometry().scale.in(query);
    PageAccessor accessor(reader_, Wait::kForPages);
    return find_side(state_->geometry(), point, ~std::uint64_t{0}, accessor.pages(), work);
  }
  const octree::MaskInfo& mask() const { return state_->geometry().mask; }

 private:
  static std::unique_ptr<ModelState> open(const SampleModel& sample) {
    OpenOptions options;
    options.memory_budget_bytes = std::uint64_t{64} << 20;
    options.max_probes = 1;
    auto state = ModelState::open(sample.path(), options);
    if (!state) std::abort();
    return *std::move(state);
  }

  std::unique_ptr<ModelState> state_;
  cache::Reader reader_;
};

TEST(ContainsMask, AnswersMostFromOneCell) {
  const Soup soup = octree::sphere(6);
  const SampleModel with = SampleModel::masked(soup), without(soup);
  CountedSides masked(with), bare(without);
  ASSERT_GT(masked.mask().page_count, 1u);
  ASSERT_EQ(bare.mask().page_count, 0u);
  const FileImage image(storage::read_bytes(with.path()));
  const unsigned levels = image.header().model.mask_levels;
  int at_once = 0;
  octree::TraversalStats all, all_bare;
  const std::vector<Vec3> queries = random_queries(2000, -1, 1);
  for (const Vec3& query : queries) {
    octree::TraversalStats work;
    const SideResult found = masked.side(query, work);
    ASSERT_EQ(found.side, bare.side(query, all_bare).side);
    ASSERT_EQ(found.status, Status::kExact);
    if (work.blocks == 0 && work.nodes <= levels) ++at_once;
    all.blocks += work.blocks;
  }
  EXPECT_GT(at_once, 1300);
  EXPECT_LT(2 * all.blocks, all_bare.blocks);
}

std::vector<Soup> nasty_soups() {
  using namespace octree;
  const Soup ball = sphere(3);
  return {joined({ball, inside_out(scaled(sphere(2), 0.5)), copies(scaled(sphere(2), 0.25), 3)}),
          joined({box({0, 0, 0}, {1, 1, 1}, 8), box({0.25, 0.25, 0.25}, {0.5, 0.75, 1}, 6),
                  inside_out(box({0.5, 0.5, 0}, {1, 0.75, 0.25}, 6))}),
          grains(300, 0.4),
          joined({height_field(12), inside_out(height_field(12))}),
          shells(130),
          box({0, 0, 0}, {0.9, 0.8, 0.7}, 30)};
}

TEST(ContainsMask, GivesTheSidesFoundWithoutAMask) {
  for (const Soup& soup : nasty_soups()) {
    const SampleModel with = SampleModel::masked(soup), without(soup);
    CountedSides masked(with), bare(without);
    ASSERT_GT(masked.mask().page_count, 0u);
    for (const Vec3& query : points_about(with, 600)) {
      octree::TraversalStats work;
      const SideResult found = masked.side(query, work), expected = bare.side(query, work);
      ASSERT_EQ(found.status, Status::kExact);
      ASSERT_EQ(found.side, expected.side) << query.x << ' ' << query.y << ' ' << query.z;
      // In a cell of one colour only the sign of the winding number is known.
      ASSERT_EQ(found.winding > 0, expected.winding > 0);
      ASSERT_EQ(found.winding < 0, expected.winding < 0);
    }
  }
}

class DamagedMask : public testing::Test {
 protected:
  DamagedMask() : sample_(SampleModel::masked(octree::sphere(5))) {
    queries_ = points_about(sample_, 400);
    answers_ = containments();
    EXPECT_GT(mask_pages(), 2u);
  }
  std::uint32_t mask_pages() const {
    return FileImage(storage::read_bytes(sample_.path())).header().model.mask_page_count;
  }
  std::vector<Containment> containments() {
    const Model model = sample_.open();
    Probe probe = make_probe(model);
    std::vector<Containment> answers;
    for (const Vec3& query : queries_) answers.push_back(probe.contains(query));
    quarantined_ = model.stats().quarantined_pages;
    return answers;
  }
  // Changes one byte, as a failing disk would; a second call restores it.
  void damage(std::uint32_t mask_page) {
    FileImage image(storage::read_bytes(sample_.path()));
    const std::span<std::byte> stored = image.stored(sample_.page_count() + mask_page);
    stored[stored.size() / 2] ^= std::byte{0x10};
    storage::write_bytes(sample_.path(), image.bytes());
  }
  void expect_same(const std::vector<Containment>& answers) const {
    for (std::size_t i = 0; i < answers.size(); ++i) {
      ASSERT_EQ(answers[i].side, answers_[i].side) << i;
      ASSERT_EQ(answers[i].status, Status::kExact) << i;
    }
  }

  SampleModel sample_;
  std::vector<Vec3> queries_;
  std::vector<Containment> answers_;
  std::uint64_t quarantined_ = 0;
};

TEST_F(DamagedMask, ChangesNoAnswer) {
  const std::uint32_t count = mask_pages();
  EXPECT_EQ(quarantined_, 0u);
  for (std::uint32_t page = 0; page < count; ++page) {
    SCOPED_TRACE(page);
    damage(page);
    expect_same(containments());
    EXPECT_EQ(quarantined_, 1u);
    damage(page);
  }
  for (std::uint32_t page = 0; page < count; ++page) damage(page);
  expect_same(containments());
  EXPECT_EQ(quarantined_, 1u);
}

TEST_F(DamagedMask, IsNotReadForDistances) {
  for (std::uint32_t page = 0; page < mask_pages(); ++page) damage(page);
  const SampleModel without(octree::sphere(5));
  const Model model = sample_.open(), bare = without.open();
  // Its first page is read once at open, for the side grid.
  EXPECT_EQ(model.stats().quarantined_pages, 1u);
  EXPECT_EQ(model.stats().pages_read, bare.stats().pages_read);
  Probe probe = make_probe(model), of_bare = make_probe(bare);
  for (const Vec3& query : queries_) {
    const QueryOptions query_options{.parts = kDistance};
    ASSERT_EQ(probe.closest_point(query, query_options).triangle,
              of_bare.closest_point(query, query_options).triangle);
  }
  EXPECT_EQ(model.stats().quarantined_pages, 1u);
  EXPECT_EQ(model.stats().pages_read, bare.stats().pages_read);
}

// A small work limit leaves sides unknown, never wrong.
TEST(ContainsMask, WorkLimitLeavesSidesUnknownNeverWrong) {
  const SampleModel sample = SampleModel::masked(octree::sphere(5));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  int known = 0, unknown = 0;
  for (const Vec3& query : points_about(sample, 100)) {
    const Side side = probe.contains(query).side;
    bool certain = false;
    for (std::uint32_t most = 0; most < 40; ++most) {
      const Containment found = probe.contains(query, {.max_work = most});
      certain = found.status == Status::kExact;
      ASSERT_EQ(found.side, certain ? side : Side::kUnknown);
      ASSERT_TRUE(certain || found.status == Status::kDegraded);
      ++(certain ? known : unknown);
    }
  }
  EXPECT_GT(known, 1000);
  EXPECT_GT(unknown, 300);
}

// Winding numbers here exceed the range of corner numbers.
TEST(ContainsMask, IsRightWhereWindingNumbersExceedCornerNumbers) {
  const SampleModel sample = SampleModel::masked(octree::shells(130));
  const Model model = sample.open();
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(1500, -1, 1)) {
    const double radius = std::hypot(query.x, query.y, query.z);
    const Containment found = probe.contains(query);
    ASSERT_EQ(found.status, Status::kExact);
    if (radius > 1 + 1e-6) {
      ASSERT_EQ(found.side, Side::kOutside);
    }
    if (radius < 0.68) {
      ASSERT_EQ(found.side, Side::kInside);
    }
  }
}

}  // namespace
}  // namespace planetree::query
