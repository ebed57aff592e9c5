// Links of nodes and of masks have another form in files with very many pages. Answers do not
// depend on it.

#include <gtest/gtest.h>

#include <algorithm>

#include "planetree/model.h"
#include "query/file/page_decoding.h"
#include "storage/file/page_file.h"
#include "tests/query/answer_bits.h"
#include "tests/query/eventually.h"
#include "tests/query/pages/same_answers.h"
#include "tests/query/pages/spread_file.h"
#include "tests/query/sample_model.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::query {
namespace {

constexpr std::uint32_t kPageBytes = BuildOptions::kMaxPageBytes;
constexpr std::uint32_t kSlotPages =
    octree::LinkFormat(kPageBytes, octree::LinkTarget::kSlot).max_pages();
// Links to families of the mask need more than 32 bits beyond so many pages.
constexpr std::uint32_t kShortMaskPages = (std::uint64_t{1} << 32) / (kPageBytes / 8);

/// One model in as few pages as it takes, and spread over many.
class FewAndMany {
 public:
  FewAndMany(const Soup& soup, std::uint32_t mask_gap) {
    BuildOptions building;
    building.keep = kKeepTriangles;
    build_soup(soup, few_, building, kPageBytes);
    spread_file(few_, many_, {kSlotPages, mask_gap});
    opening_.max_probes = 1;
    opening_.memory_budget_bytes = std::uint64_t{64} << 20;
  }

  Model few() const { return open(few_); }
  Model many() const { return open(many_); }
  storage::FileHeader header() const {
    const auto file = storage::PageFile::open(many_);
    EXPECT_TRUE(file) << file.error().text;
    return file->header();
  }

 private:
  Model open(const std::filesystem::path& path) const {
    auto model = Model::open(path, opening_);
    EXPECT_TRUE(model) << model.error().text;
    return *std::move(model);
  }

  storage::TemporaryDirectory folder_;
  const std::filesystem::path few_ = folder_ / "few.ptree", many_ = folder_ / "many.ptree";
  OpenOptions opening_;
};

Soup without_each(const Soup& whole, std::size_t step) {
  Soup soup;
  for (std::size_t i = 0; i < whole.size(); ++i)
    if (i % step != 0) soup.push_back(whole[i]);
  return soup;
}

std::vector<Vec3> near_and_far(std::size_t count) {
  return points_around_sphere(count, 0.9995, 0.001);
}

void expect_same_points(const Model& few, const Model& many, std::size_t count) {
  Probe of_few = make_probe(few), of_many = make_probe(many);
  std::size_t inside = 0;
  for (const Vec3& query : near_and_far(count)) {
    const ClosestPoint expected = of_few.closest_point(query);
    ASSERT_EQ(bits_of(of_many.closest_point(query)), bits_of(expected));
    ASSERT_EQ(expected.status, Status::kExact);
    ASSERT_EQ(of_many.contains(query).side, expected.side);
    inside += expected.side == Side::kInside ? 1 : 0;
  }
  EXPECT_GT(inside, count / 10);
  EXPECT_LT(inside, count - count / 10);
}

void expect_same_answers(const Model& few, const Model& many, std::size_t count) {
  Probe of_few = make_probe(few), of_many = make_probe(many);
  const std::vector<Vec3> queries = near_and_far(count);
  expect_same_in_each_way(of_few, of_many, queries);
  std::vector<ClosestPoint> expected(queries.size()), found(queries.size());
  of_few.closest_points(queries, expected);
  of_many.closest_points(queries, found);
  for (std::size_t i = 0; i < queries.size(); ++i)
    ASSERT_EQ(bits_of(found[i]), bits_of(expected[i])) << i;
}

TEST(ManyPages, AnswerAsFew) {
  const Soup soup = octree::sphere(7);
  const FewAndMany both(soup, kShortMaskPages);
  const storage::FileHeader header = both.header();
  EXPECT_EQ(block_shape(header).links, octree::LinkTarget::kNumber);
  ASSERT_GT(header.first_cap_page(), kSlotPages + 10);
  ASSERT_GT(header.model.mask_page_count, kShortMaskPages + 1);
  const Model few = both.few(), many = both.many();
  expect_same_points(few, many, 20'000);
  expect_same_answers(few, many, 1000);
  expect_same_triangles(few, many, soup.size(), 97);
  // Those of the mask too: without it, sides would be found by rays. The pages added are damaged.
  EXPECT_EQ(many.stats().pages_read, header.page_count - kSlotPages - kShortMaskPages);
  EXPECT_EQ(many.stats().quarantined_pages, 0u);
}

TEST(ManyPages, AnswerAsFewOnAnOpenSurface) {
  const Soup soup = without_each(octree::sphere(7), 300);
  const FewAndMany both(soup, 0);
  const storage::FileHeader header = both.header();
  EXPECT_EQ(cap_shape(header).links, octree::LinkTarget::kNumber);
  ASSERT_GT(header.first_cap_page(), kSlotPages);
  ASSERT_GT(header.model.cap_page_count, 0u);
  const Model few = both.few(), many = both.many();
  expect_same_points(few, many, 5000);
  expect_same_answers(few, many, 500);
  expect_same_triangles(few, many, soup.size() / 2, 97);
}

TEST(ManyPages, ComeWhileQueriesDoNotWait) {
  const FewAndMany both(octree::sphere(7), 0);
  const Model few = both.few(), many = both.many();
  Probe of_few = make_probe(few), of_many = make_probe(many);
  for (const Vec3& query : near_and_far(20)) {
    const ClosestPoint expected = of_few.closest_point(query);
    EXPECT_TRUE(eventually([&] {
      const ClosestPoint answer = of_many.closest_point(query, {.wait = Wait::kNever});
      EXPECT_LE(answer.lower, expected.upper);
      EXPECT_GE(answer.upper, expected.lower);
      return answer.status == Status::kExact && bits_of(answer) == bits_of(expected);
    }));
  }
}

}  // namespace
}  // namespace planetree::query
