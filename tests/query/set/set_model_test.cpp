// A set answers as the one file does, bit for bit.

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "planetree/scene.h"
#include "query/model_state.h"
#include "storage/set/set_description.h"
#include "tests/query/answer_bits.h"
#include "tests/query/eventually.h"
#include "tests/query/pages/same_answers.h"
#include "tests/query/sample_model.h"
#include "tests/storage/set/sample_set.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::query {
namespace {

constexpr std::size_t kMembers = 8;

/// One model as a file and as a set of 8 members or more.
class FileAndSet {
 public:
  explicit FileAndSet(const Soup& soup, BuildOptions options = {}) {
    build_soup(soup, file(), options);
    options.member_bytes = BuildOptions::kMinMemberBytes;
    build_soup(soup, set(), options);
    const storage::SetDescription description = storage::description_of(set());
    EXPECT_GE(description.members.size(), kMembers);
    for (const storage::SetMember& member : description.members)
      members_.push_back(folder_ / member.address.c_str());
    options_.max_probes = 1;
    // Most pages are read more than once.
    options_.memory_budget_bytes = *ModelState::min_budget_bytes(file(), options_) + 40 * 4096;
  }

  std::filesystem::path file() const { return folder_ / "model.ptree"; }
  std::filesystem::path set() const { return folder_ / "model.ptreeset"; }
  const std::vector<std::filesystem::path>& members() const { return members_; }
  Model open(const std::filesystem::path& path) const {
    auto model = Model::open(path, options_);
    EXPECT_TRUE(model) << model.error().text;
    return *std::move(model);
  }
  OpenOptions& options() { return options_; }

 private:
  storage::TemporaryDirectory folder_;
  std::vector<std::filesystem::path> members_;
  OpenOptions options_;
};

// A sphere of 32,768 triangles, of which each `step`th one is missing; 0: none.
Soup sphere_without(unsigned step) {
  const Soup whole = octree::sphere(6);
  Soup soup;
  for (std::size_t i = 0; i < whole.size(); ++i)
    if (step == 0 || i % step != 0) soup.push_back(whole[i]);
  return soup;
}

std::vector<Vec3> near_and_far(std::size_t count) {
  return points_around_sphere(count, 0.98, 0.04);
}

void expect_same(FileAndSet& both, std::size_t count) {
  const Model file = both.open(both.file()), set = both.open(both.set());
  Probe of_file = make_probe(file), of_set = make_probe(set);
  std::size_t sides[3] = {};
  for (const Vec3& query : near_and_far(count)) {
    const ClosestPoint expected = of_file.closest_point(query);
    ASSERT_EQ(bits_of(of_set.closest_point(query)), bits_of(expected));
    ASSERT_EQ(expected.status, Status::kExact);
    ASSERT_EQ(of_set.contains(query).side, of_file.contains(query).side);
    ++sides[expected.side == Side::kInside ? 0 : expected.side == Side::kOutside ? 1 : 2];
  }
  EXPECT_GT(sides[0], count / 10);
  EXPECT_GT(sides[1], count / 10);
  EXPECT_GT(set.stats().pages_evicted, 100u);
  EXPECT_EQ(set.info().content_id[0], file.info().content_id[0]);
  EXPECT_EQ(set.info().content_id[1], file.info().content_id[1]);
}

TEST(SetModels, AnswerAsTheFile) {
  FileAndSet both(sphere_without(0));
  expect_same(both, 100'000);
}

TEST(SetModels, AnswerAsTheFileOfAnOpenSurface) {
  FileAndSet both(sphere_without(1000));
  expect_same(both, 20'000);
}

TEST(SetModels, AnswerAsTheFileInEachWay) {
  BuildOptions keeping;
  keeping.keep = kKeepTriangles;
  FileAndSet both(sphere_without(500), keeping);
  const Model file = both.open(both.file()), set = both.open(both.set());
  Probe of_file = make_probe(file), of_set = make_probe(set);
  expect_same_in_each_way(of_file, of_set, near_and_far(2000));
  expect_same_triangles(file, set, 3000, 7);
}

TEST(SetModels, AnswerBatchesByThreads) {
  FileAndSet both(sphere_without(0));
  const std::vector<Vec3> queries = near_and_far(5000);
  std::vector<ClosestPoint> expected(queries.size()), found(queries.size());
  make_probe(both.open(both.file())).closest_points(queries, expected);
  both.options().batch_threads = 2;
  both.options().fetch_threads = 2;
  both.options().memory_budget_bytes += std::uint64_t{4} << 20;
  const Model set = both.open(both.set());
  make_probe(set).closest_points(queries, found);
  for (std::size_t i = 0; i < queries.size(); ++i)
    ASSERT_EQ(bits_of(found[i]), bits_of(expected[i])) << i;
}

TEST(SetModels, StandInScenes) {
  FileAndSet both(sphere_without(0));
  SceneOptions options;
  options.memory_budget_bytes = std::uint64_t{8} << 20;
  options.max_page_bytes = 4096;
  options.max_probes = 1;
  options.locking = Locking::kNever;
  auto scene = Scene::create(options);
  ASSERT_TRUE(scene) << scene.error().text;
  ASSERT_TRUE(scene->add(both.set()));
  const Model file = both.open(both.file());
  Probe probe = make_probe(file);
  auto of_scene = SceneProbe::create(*scene);
  ASSERT_TRUE(of_scene) << of_scene.error().text;
  for (const Vec3& query : near_and_far(1000)) {
    const auto answer = of_scene->closest_point(query);
    ASSERT_EQ(bits_of(answer), bits_of(probe.closest_point(query)));
  }
}

TEST(SetModels, NeverWaitAndThenKnow) {
  FileAndSet both(sphere_without(0));
  const Model file = both.open(both.file()), set = both.open(both.set());
  Probe of_file = make_probe(file), of_set = make_probe(set);
  const Vec3 query{0.5, 0.6, 0.62};
  const ClosestPoint expected = of_file.closest_point(query);
  EXPECT_TRUE(eventually([&] {
    const ClosestPoint answer = of_set.closest_point(query, {.wait = Wait::kNever});
    EXPECT_LE(answer.lower, expected.upper);
    EXPECT_GE(answer.upper, expected.lower);
    return answer.status == Status::kExact && bits_of(answer) == bits_of(expected);
  }));
}

TEST(SetModels, OpenWithoutMembersIfAllowed) {
  FileAndSet both(sphere_without(0));
  const Model file = both.open(both.file());
  Probe of_file = make_probe(file);
  std::filesystem::remove(both.members()[4]);
  const auto refused = Model::open(both.set(), both.options());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNotFound);
  both.options().allow_missing_members = true;
  const Model set = both.open(both.set());
  Probe of_set = make_probe(set);
  std::size_t exact = 0, degraded = 0;
  for (const Vec3& query : near_and_far(4000)) {
    const ClosestPoint expected = of_file.closest_point(query);
    const ClosestPoint answer = of_set.closest_point(query);
    ASSERT_LE(answer.lower, expected.upper);
    ASSERT_GE(answer.upper, expected.lower);
    if (answer.status != Status::kExact) {
      ++degraded;
      continue;
    }
    ++exact;
    ASSERT_EQ(bits_of(answer), bits_of(expected));
  }
  EXPECT_GT(exact, 1000u);
  EXPECT_GT(degraded, 100u);
  const auto error = set.read_error();
  ASSERT_TRUE(error);
  EXPECT_NE(std::string(error->text).find(both.members()[4].filename().string()), std::string::npos)
      << error->text;
}

// A member of another model has the right length at best. Its pages do not have the right hashes.
TEST(SetModels, DoNotMixModels) {
  FileAndSet both(sphere_without(0));
  const Model file = both.open(both.file());
  Probe of_file = make_probe(file);
  storage::Bytes bytes = storage::read_bytes(both.members()[3]);
  std::reverse(bytes.begin(), bytes.end());
  storage::write_bytes(both.members()[3], bytes);
  const Model set = both.open(both.set());
  Probe of_set = make_probe(set);
  std::size_t degraded = 0;
  for (const Vec3& query : near_and_far(2000)) {
    const ClosestPoint answer = of_set.closest_point(query);
    if (answer.status == Status::kExact) {
      ASSERT_EQ(bits_of(answer), bits_of(of_file.closest_point(query)));
    } else {
      ++degraded;
    }
  }
  EXPECT_GT(degraded, 10u);
  EXPECT_GT(set.stats().quarantined_pages, 0u);
}

TEST(SetModels, HaveBoxesOfTheirTriangles) {
  FileAndSet both(sphere_without(0));
  const storage::SetDescription description = storage::description_of(both.set());
  double lower = 2, upper = -2;
  for (const storage::SetMember& member : description.members) {
    if (!member.box) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_LT(member.box->lower[axis], member.box->upper[axis]);
      EXPECT_GE(member.box->lower[axis], -1);
      EXPECT_LE(member.box->upper[axis], 1);
    }
    lower = std::min(lower, member.box->lower[0]);
    upper = std::max(upper, member.box->upper[0]);
  }
  EXPECT_EQ(lower, -1);
  EXPECT_EQ(upper, 1);
}

}  // namespace
}  // namespace planetree::query
