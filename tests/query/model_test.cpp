#include "planetree/model.h"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file/file_image.h"

namespace planetree::query {
namespace {

using octree::repeated;
using octree::scattered;
using octree::sphere;

TEST(Model, FailsToOpenMissingFilesAndDirectories) {
  const storage::TemporaryDirectory folder;
  const auto missing = Model::open(folder / "none.ptree");
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, ErrorCode::kNotFound);
  const auto directory = Model::open(folder / "");
  ASSERT_FALSE(directory);
  EXPECT_EQ(directory.error().code, ErrorCode::kNotPlanetree);
}

TEST(Model, RefusesFilesOfOtherKindsAndLengths) {
  const SampleModel sample(sphere(2));
  std::ofstream(sample.path(), std::ios::app) << 'x';
  auto model = Model::open(sample.path());
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kTruncated);
  std::ofstream(sample.path()) << "ply\nformat ascii 1.0\n" << std::string(1000, ' ');
  model = Model::open(sample.path());
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kNotPlanetree);
}

TEST(Model, RefusesAFileWhoseRootIsDamaged) {
  const SampleModel sample(sphere(4));
  storage::FileImage image(storage::read_bytes(sample.path()));
  image.stored(0)[30] ^= std::byte{1};
  storage::write_bytes(sample.path(), image.bytes());
  const auto model = Model::open(sample.path());
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kDamaged);
  EXPECT_EQ(model.error().page, 0u);
}

TEST(Model, ErrorNamesTheMinimumBudget) {
  const SampleModel sample(sphere(5));
  for (const unsigned probes : {1u, 3u, 16u}) {
    const std::uint64_t least = sample.min_budget(probes);
    ASSERT_GT(least, 0u);
    OpenOptions options;
    options.max_probes = probes;
    options.memory_budget_bytes = least - 1;
    const auto refused = Model::open(sample.path(), options);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::kNoMemory);
    options.memory_budget_bytes = least;
    const auto opened = Model::open(sample.path(), options);
    ASSERT_TRUE(opened) << opened.error().text;
    EXPECT_LE(opened->stats().arena_bytes + opened->stats().table_bytes, least);
  }
}

void expect_bad_argument(const SampleModel& sample, const OpenOptions& options) {
  const auto model = Model::open(sample.path(), options);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, ErrorCode::kBadArgument);
}

TEST(Model, RefusesBatchThreadsOutOfRange) {
  const SampleModel sample(repeated(1));
  for (const unsigned threads : {0u, OpenOptions::kMaxBatchThreads + 1, ~0u}) {
    OpenOptions options;
    options.batch_threads = threads;
    expect_bad_argument(sample, options);
  }
}

// The memory of batch threads counts towards the budget.
TEST(Model, CountsBatchThreadsIntoTheBudget) {
  const SampleModel sample(sphere(5));
  OpenOptions options;
  options.max_probes = 1;
  options.memory_budget_bytes = sample.min_budget(1);
  ASSERT_TRUE(Model::open(sample.path(), options));
  options.batch_threads = 8;
  const auto refused = Model::open(sample.path(), options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNoMemory);
}

TEST(Model, RefusesMaxProbesOutOfRange) {
  const SampleModel sample(repeated(1));
  for (const unsigned probes : {0u, 1025u, ~0u}) {
    OpenOptions options;
    options.max_probes = probes;
    expect_bad_argument(sample, options);
  }
}

TEST(Model, RefusesAnUnknownEvictionPolicy) {
  const SampleModel sample(repeated(1));
  OpenOptions options;
  options.policy = static_cast<EvictionPolicy>(5);
  expect_bad_argument(sample, options);
}

// The memory of the eviction policy counts towards the budget.
TEST(Model, CountsTheEvictionPolicyIntoTheBudget) {
  const SampleModel sample(sphere(6), 4096);
  const auto frames = [&sample](EvictionPolicy policy) {
    OpenOptions options;
    options.max_probes = 1;
    options.policy = policy;
    options.memory_budget_bytes = sample.min_budget(1) + sample.page_count() / 2 * 4096;
    const auto model = Model::open(sample.path(), options);
    EXPECT_TRUE(model);
    EXPECT_LE(model->stats().arena_bytes + model->stats().table_bytes, options.memory_budget_bytes);
    return model->stats().frames;
  };
  EXPECT_LT(frames(EvictionPolicy::kTwoQ), frames(EvictionPolicy::kClock));
}

// The model's own threads claim readers too; the error counts only what callers may have.
TEST(Model, NamesTheLimitOfProbesThatCallersHave) {
  const SampleModel sample(repeated(1));
  const Model model = sample.open_for_batches(2, 3);
  std::vector<Probe> probes;
  for (int i = 0; i < 3; ++i) probes.push_back(*Probe::create(model));
  const auto refused = Probe::create(model);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadArgument);
  EXPECT_STREQ(refused.error().text,
               "the limit of 3 probes is reached: open the model with a larger max_probes");
}

TEST(Model, InfoDescribesTheFile) {
  const SampleModel sample(sphere(5));
  const Model model = sample.open();
  const ModelInfo& info = model.info();
  EXPECT_EQ(info.triangles, 8u * 1024);
  EXPECT_EQ(info.skipped, 0u);
  EXPECT_EQ(info.first_skipped, kNoTriangle);
  EXPECT_EQ(info.vertices, 3u * 8 * 1024);
  EXPECT_EQ(info.box_lower.x, -1);
  EXPECT_EQ(info.box_upper.z, 1);
  EXPECT_FALSE(info.float64);
  EXPECT_EQ(info.nodes, sample.sample().tree.nodes.size());
  EXPECT_EQ(info.blocks, sample.sample().tree.blocks.size());
  EXPECT_EQ(info.levels, sample.sample().tree.nodes[0].height);
  EXPECT_EQ(info.pages, sample.page_count());
  EXPECT_EQ(info.page_bytes, 4096u);
  EXPECT_EQ(info.file_bytes, std::filesystem::file_size(sample.path()));
  EXPECT_EQ(
      info.section_bytes.headers + info.section_bytes.directory + info.section_bytes.distance_pages,
      info.file_bytes);
  EXPECT_NE(info.content_id[0] | info.content_id[1], 0u);
  EXPECT_TRUE(SampleModel(scattered(5, 1)).open().info().float64);
}

TEST(Model, GivesEqualModelsOneContentId) {
  const SampleModel one(sphere(3)), same(sphere(3)), other(sphere(2));
  const Model a = one.open(), b = same.open(), c = other.open();
  EXPECT_EQ(a.info().content_id[0], b.info().content_id[0]);
  EXPECT_EQ(a.info().content_id[1], b.info().content_id[1]);
  EXPECT_NE(a.info().content_id[0], c.info().content_id[0]);
}

TEST(Model, StatsCountReadsHitsAndMisses) {
  const SampleModel sample(sphere(5));
  const Model model = sample.open();
  EXPECT_EQ(model.stats().pages_read, 1u);  // the root
  EXPECT_EQ(model.stats().frames, sample.page_count());
  EXPECT_EQ(model.stats().budget_bytes, std::uint64_t{64} << 20);
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(300, -1.2, 1.2)) probe.closest_point(query);
  const Stats stats = model.stats();
  EXPECT_EQ(stats.pages_evicted, 0u);
  EXPECT_EQ(stats.page_misses + 1, stats.pages_read);
  EXPECT_GT(stats.page_hits, stats.page_misses);
  EXPECT_LE(stats.pages_read, sample.page_count());
  EXPECT_EQ(stats.degraded_answers, 0u);
  EXPECT_EQ(stats.quarantined_pages, 0u);
  EXPECT_FALSE(stats.header_copy_damaged);
}

TEST(Model, StaysWithinItsBudgetAndEvicts) {
  const SampleModel sample(sphere(5));
  const std::uint64_t budget = sample.min_budget();
  const Model model = sample.open(budget);
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(300, -1.2, 1.2)) probe.closest_point(query);
  const Stats stats = model.stats();
  EXPECT_LT(stats.frames, sample.page_count());
  EXPECT_LE(stats.arena_bytes + stats.table_bytes, budget);
  EXPECT_GT(stats.pages_evicted, 0u);
  EXPECT_LE(stats.pages_read - stats.pages_evicted, stats.frames);
}

TEST(Model, ReportsADamagedHeaderCopy) {
  const SampleModel sample(sphere(3));
  storage::Bytes bytes = storage::read_bytes(sample.path());
  bytes[20] ^= std::byte{4};
  storage::write_bytes(sample.path(), bytes);
  const Model model = sample.open();
  EXPECT_TRUE(model.stats().header_copy_damaged);
  EXPECT_EQ(make_probe(model).closest_point({0, 0, 5}).status, Status::kExact);
}

TEST(Model, RefusesMoreProbesThanMaxProbes) {
  const SampleModel sample(sphere(2));
  const Model model = sample.open(std::uint64_t{1} << 20, 3);
  std::vector<Probe> probes;
  for (int i = 0; i < 3; ++i) probes.push_back(make_probe(model));
  const auto refused = Probe::create(model);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kBadArgument);
  probes.pop_back();
  EXPECT_TRUE(Probe::create(model));
}

TEST(Model, ProbesSurviveAMoveOfTheModel) {
  const SampleModel sample(sphere(4));
  Model first = sample.open(std::uint64_t{4} << 20, 2);
  std::optional<Model> second;  // declared here, because models must outlive their probes
  Probe probe = make_probe(first);
  const ClosestPoint before = probe.closest_point({0.3, 0.4, 0.5});
  second.emplace(std::move(first));
  EXPECT_EQ(bits_of(probe.closest_point({0.3, 0.4, 0.5})), bits_of(before));
  EXPECT_EQ(second->info().triangles, 2048u);
  EXPECT_EQ(bits_of(make_probe(*second).closest_point({0.3, 0.4, 0.5})), bits_of(before));
}

TEST(Model, MoveAssignmentReplacesTheModel) {
  const SampleModel one(sphere(2)), other(sphere(3));
  Model model = one.open();
  model = other.open();
  EXPECT_EQ(model.info().triangles, 512u);
  EXPECT_EQ(make_probe(model).closest_point({0, 0, 3}).distance, 2);
}

TEST(Probe, MoveReleasesItsSlotExactlyOnce) {
  const SampleModel sample(sphere(3));
  const Model model = sample.open(std::uint64_t{1} << 20, 2);
  {
    Probe first = make_probe(model);
    Probe second = std::move(first);
    EXPECT_EQ(second.closest_point({0, 0, 3}).distance, 2);
    Probe third = make_probe(model);
    EXPECT_FALSE(Probe::create(model));
    third = std::move(second);  // releases a reader slot
    EXPECT_EQ(third.closest_point({0, 0, -4}).distance, 3);
    EXPECT_TRUE(Probe::create(model));
  }
  std::vector<Probe> probes;
  for (int i = 0; i < 2; ++i) probes.push_back(make_probe(model));
}

}  // namespace
}  // namespace planetree::query
