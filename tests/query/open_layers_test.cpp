// Models of which only some layers are opened.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "planetree/planetree.h"
#include "query/model_state.h"
#include "tests/octree/support/sample_tree.h"
#include "tests/query/answer_bits.h"
#include "tests/query/fetch_steps.h"
#include "tests/query/least_memory.h"
#include "tests/query/sample_model.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::query {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::uint32_t, 5> kChoices = {0, kDistanceLayer, kDistanceLayer | kSideLayer,
                                                   kDistanceLayer | kFieldLayer, kAllLayers};

// Those of the files here.
constexpr std::uint32_t kLayers = kDistanceLayer | kSideLayer | kFieldLayer;

FetchWorker::Seconds standing_time() { return FetchWorker::Seconds(1); }

// A sphere, one with a hole, and a sheet.
class OpenLayersOfModels : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<storage::TemporaryDirectory>();
    octree::Soup sphere = octree::sphere(5);
    build_soup(sphere, *folder_ / "closed.ptree");
    sphere.erase(sphere.begin(), sphere.begin() + 300);
    build_soup(sphere, *folder_ / "open.ptree");
    build_soup(octree::height_field(40), *folder_ / "sheet.ptree");
    corrupt("closed.ptree", kSideLayer, "closed_side.ptree");
    corrupt("open.ptree", kSideLayer, "open_side.ptree");
    corrupt("open.ptree", kFieldLayer, "open_field.ptree");
  }
  static void TearDownTestSuite() { folder_.reset(); }

  // Writes a copy of a file of which every page of a layer has a wrong hash.
  static void corrupt(const char* name, std::uint32_t layer, const char* copy) {
    storage::FileImage image(storage::read_bytes(*folder_ / name));
    const storage::FileHeader header = image.header();
    for (std::uint32_t page = header.first_cap_page(); page < header.page_count; ++page) {
      const bool is_field = page >= header.first_field_page() && page < header.first_mask_page();
      if (is_field == (layer == kFieldLayer)) image.stored(page)[0] ^= std::byte{1};
    }
    storage::write_bytes(*folder_ / copy, image.bytes());
  }
  static storage::FileHeader header_of(const char* name) {
    return storage::FileImage(storage::read_bytes(*folder_ / name)).header();
  }
  static OpenOptions options_of(std::uint32_t layers) {
    OpenOptions options;
    options.max_probes = 3;
    options.memory_budget_bytes = std::uint64_t{64} << 20;
    options.layers = layers;
    return options;
  }
  static Model open(const char* name, std::uint32_t layers, bool starts_fetching = false) {
    auto model = ModelState::open_model(*folder_ / name, options_of(layers),
                                        {storage::FileCalls::real(), starts_fetching});
    if (!model) throw std::runtime_error(model.error().text);
    return *std::move(model);
  }

  static std::unique_ptr<storage::TemporaryDirectory> folder_;
};

std::unique_ptr<storage::TemporaryDirectory> OpenLayersOfModels::folder_;

TEST_F(OpenLayersOfModels, AreThoseOfTheFileThatTheOptionsName) {
  for (const std::uint32_t layers : kChoices) {
    const Model model = open("open.ptree", layers);
    EXPECT_EQ(model.info().layers, kLayers);
    EXPECT_EQ(model.stats().layers, (layers & kLayers) | kDistanceLayer);
  }
  EXPECT_EQ(open("sheet.ptree", kAllLayers).info().layers, kLayers);
}

TEST_F(OpenLayersOfModels, RefuseBitsThatAreNone) {
  for (const std::uint32_t bits : {16U, kAllLayers + 1, ~0U}) {
    const auto model = Model::open(*folder_ / "closed.ptree", options_of(bits));
    ASSERT_FALSE(model);
    EXPECT_EQ(model.error().code, ErrorCode::kBadArgument);
  }
}

TEST_F(OpenLayersOfModels, GiveTheSameBitsOfDistances) {
  for (const char* name : {"closed.ptree", "open.ptree", "sheet.ptree"}) {
    const Model whole = open(name, kAllLayers);
    Probe all = make_probe(whole);
    for (const std::uint32_t layers : kChoices) {
      const Model model = open(name, layers);
      Probe probe = make_probe(model);
      for (const Vec3& query : random_queries(150, -1.5, 1.5)) {
        const QueryOptions distance{.parts = kDistance};
        EXPECT_EQ(bits_of(probe.closest_point(query, distance)),
                  bits_of(all.closest_point(query, distance)));
        const ClosestPoint answer = probe.closest_point(query), truth = all.closest_point(query);
        EXPECT_EQ(answer.distance, truth.distance);
        EXPECT_EQ(answer.triangle, truth.triangle);
        if ((layers & kSideLayer) == 0) continue;
        EXPECT_EQ(bits_of(answer), bits_of(truth));
      }
    }
  }
}

TEST_F(OpenLayersOfModels, KeepSidesUnknownWithoutTheSideLayer) {
  for (const char* name : {"closed.ptree", "open.ptree"}) {
    const Model whole = open(name, kAllLayers), model = open(name, kFieldLayer);
    Probe all = make_probe(whole), probe = make_probe(model);
    const auto queries = random_queries(150, -1.5, 1.5);
    for (const Vec3& query : queries) {
      for (const std::uint32_t parts : {kSide, kDistance | kSide, kAllParts}) {
        const ClosestPoint answer = probe.closest_point(query, {.parts = parts});
        EXPECT_EQ(answer.side, Side::kUnknown);
        EXPECT_EQ(answer.status, Status::kDegraded);
      }
      const Containment contained = probe.contains(query);
      EXPECT_EQ(contained.side, Side::kUnknown);
      EXPECT_EQ(contained.status, Status::kDegraded);
      // As the mesh is oriented, like those of a sheet.
      const ClosestPoint oriented = all.closest_point(query, {.side_rule = SideRule::kSurface});
      const ClosestPoint answer = probe.closest_point(query);
      EXPECT_EQ(answer.normal.x, oriented.normal.x);
      EXPECT_EQ(answer.normal.y, oriented.normal.y);
      EXPECT_EQ(answer.normal.z, oriented.normal.z);
    }
    const Stats stats = model.stats();
    EXPECT_EQ(stats.degraded_answers, 5 * queries.size());
    EXPECT_EQ(stats.degraded_without_misses, 5 * queries.size());
  }
}

// By the nearest feature, sides need the tree alone.
TEST_F(OpenLayersOfModels, TellSidesOfSheetsWithoutTheSideLayer) {
  for (const char* name : {"closed.ptree", "open.ptree", "sheet.ptree"}) {
    const Model whole = open(name, kAllLayers), model = open(name, kDistanceLayer);
    const bool is_sheet = whole.info().side_rule == SideRule::kSurface;
    EXPECT_EQ(is_sheet, std::string(name) == "sheet.ptree");
    const QueryOptions options{.side_rule = is_sheet ? SideRule::kOfFile : SideRule::kSurface};
    Probe all = make_probe(whole), probe = make_probe(model);
    for (const Vec3& query : random_queries(150, -1.5, 1.5)) {
      const ClosestPoint answer = probe.closest_point(query, options);
      EXPECT_EQ(bits_of(answer), bits_of(all.closest_point(query, options)));
      EXPECT_NE(answer.side, Side::kUnknown);
      const Containment contained = probe.contains(query, options);
      EXPECT_EQ(contained.side, answer.side);
      EXPECT_EQ(contained.status, Status::kExact);
    }
  }
}

// The pages of the side layer are damaged, so that reading one of them would show.
TEST_F(OpenLayersOfModels, ReadNoSidePage) {
  for (const char* name : {"closed_side.ptree", "open_side.ptree"}) {
    EXPECT_GT(open(name, kAllLayers).stats().quarantined_pages, 0u);
    const Model model = open(name, kFieldLayer);
    const ModelState& state = ModelState::of(model);
    const std::atomic<bool> never{false};
    FetchWorker worker = fetch_worker(state, &standing_time, never);
    Probe probe = make_probe(model), moving = make_probe(model);
    const auto queries = random_queries(200, -1.2, 1.2);
    for (const Vec3& query : queries) {
      moving.motion(query, {query.y, query.z, query.x});
      (void)moving.closest_point(query, {.wait = Wait::kNever});
      (void)moving.contains(query, {.wait = Wait::kNever});
      while (worker.work() != FetchWorker::Action::kNone) {
      }
      (void)probe.closest_point(query);
      (void)probe.closest_point(query, {.max_error = 0.01});
      (void)probe.contains(query);
    }
    std::vector<ClosestPoint> answers(queries.size());
    probe.closest_points(queries, answers);
    std::vector<Containment> contained(queries.size());
    probe.contains(queries, contained);
    const Stats stats = model.stats();
    EXPECT_EQ(stats.quarantined_pages, 0u);
    EXPECT_GT(stats.pages_read, 0u);
    EXPECT_LE(stats.pages_read, header_of(name).first_cap_page());
  }
}

TEST_F(OpenLayersOfModels, TraceNoSidePage) {
  OpenOptions options = options_of(kDistanceLayer);
  options.page_trace_capacity = 1 << 12;
  const auto model =
      ModelState::open_model(*folder_ / "open.ptree", options, {storage::FileCalls::real(), false});
  ASSERT_TRUE(model);
  const std::atomic<bool> never{false};
  FetchWorker worker = fetch_worker(ModelState::of(*model), &standing_time, never);
  Probe probe = make_probe(*model);
  std::size_t count = 0;
  for (const Vec3& query : random_queries(200, -1.2, 1.2)) {
    probe.motion(query, {query.y, query.z, query.x});
    (void)probe.closest_point(query, {.wait = Wait::kNever});
    worker.work();
    std::vector<PageAccess> accesses(1 << 12);
    accesses.resize(model->drain_page_trace(accesses));
    count += accesses.size();
    for (const PageAccess& access : accesses)
      EXPECT_LT(access.page, header_of("open.ptree").first_cap_page());
  }
  EXPECT_GT(count, 200u);
  EXPECT_EQ(model->stats().page_trace_dropped, 0u);
}

TEST_F(OpenLayersOfModels, ReadNoFieldPage) {
  EXPECT_TRUE(open("open_field.ptree", kAllLayers).stats().field_damaged);
  const Model model = open("open_field.ptree", kSideLayer);
  EXPECT_FALSE(model.stats().field_damaged);
  Probe probe = make_probe(model);
  for (const Vec3& query : random_queries(100, -1.2, 1.2)) {
    const ClosestPoint answer = probe.closest_point(query, {.parts = kDistance, .max_error = 0.3});
    EXPECT_NE(answer.triangle, kNoTriangle);
    EXPECT_LE(answer.upper - answer.lower, 0.3);
    EXPECT_NE(probe.contains(query).side, Side::kUnknown);
  }
}

TEST_F(OpenLayersOfModels, TakeNoMemoryForOthers) {
  for (const char* name : {"closed.ptree", "open.ptree"}) {
    const fs::path path = *folder_ / name;
    const auto least = [&](std::uint32_t layers) {
      const std::uint64_t bytes = least_memory_bytes(path, options_of(layers));
      const auto stated = ModelState::min_budget_bytes(path, options_of(layers));
      EXPECT_TRUE(stated && *stated == bytes);
      return bytes;
    };
    const storage::FileHeader header = header_of(name);
    // Roundings to pages of the system are less than what a layer takes.
    EXPECT_GE(least(kAllLayers), least(kDistanceLayer | kSideLayer) + 4096);
    EXPECT_GE(least(kAllLayers), least(kDistanceLayer | kFieldLayer) + 8192);
    EXPECT_GE(least(kDistanceLayer | kSideLayer), least(kDistanceLayer) + 8192);
    EXPECT_EQ(least(kDistanceLayer), least(0));
    EXPECT_EQ(open(name, kDistanceLayer).stats().frames, header.first_cap_page());
    const std::uint32_t field = header.first_mask_page() - header.first_field_page();
    EXPECT_GT(field, 0u);
    EXPECT_EQ(open(name, kAllLayers).stats().frames, header.page_count - field);
  }
}

// With the least memory pages are evicted all the time.
TEST_F(OpenLayersOfModels, AnswerWithinTheLeastMemory) {
  const Model whole = open("open.ptree", kAllLayers);
  Probe all = make_probe(whole);
  for (const std::uint32_t layers : kChoices) {
    OpenOptions options = options_of(layers);
    options.memory_budget_bytes = least_memory_bytes(*folder_ / "open.ptree", options);
    const auto model = Model::open(*folder_ / "open.ptree", options);
    ASSERT_TRUE(model) << model.error().text;
    Probe probe = make_probe(*model);
    for (const Vec3& query : random_queries(60, -1.5, 1.5))
      EXPECT_EQ(bits_of(probe.closest_point(query, {.parts = kDistance})),
                bits_of(all.closest_point(query, {.parts = kDistance})));
  }
}

}  // namespace
}  // namespace planetree::query
