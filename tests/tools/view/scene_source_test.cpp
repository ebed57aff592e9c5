#include "tools/view/scene_source.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <set>
#include <string>
#include <vector>

#include "tests/tools/view/scene_fixture.h"
#include "tests/tools/view/settled_answer.h"

namespace planetree::tools {
namespace {

/// A shape as the page reads it.
struct SentShape {
  std::uint32_t discs = 0, triangles = 0, complete = 0, pages_read = 0;
  std::vector<std::array<float, 16>> disc_words;
  std::vector<std::array<float, 12>> triangle_words;

  explicit SentShape(const std::string& bytes) {
    std::uint32_t head[8];
    std::memcpy(head, bytes.data(), sizeof head);
    discs = head[0], triangles = head[1], complete = head[2], pages_read = head[3];
    disc_words.resize(discs);
    triangle_words.resize(triangles);
    const char* const data = bytes.data() + sizeof head;
    std::memcpy(disc_words.data(), data, 64 * std::size_t{discs});
    std::memcpy(triangle_words.data(), data + 64 * std::size_t{discs}, 48 * std::size_t{triangles});
  }
  std::vector<std::size_t> triangles_by_instance(std::size_t instances) const {
    std::vector<std::size_t> counts(instances);
    for (const auto& words : triangle_words) ++counts.at(static_cast<std::size_t>(words[11]));
    return counts;
  }
};

class SceneSourceTest : public SceneFiles {
 protected:
  void SetUp() override {
    SceneFiles::SetUp();
    open("scene.json");
  }
  void open(const char* file) {
    SceneFailure failure;
    source_ = SceneSource::open(file, std::nullopt, failure);
    ASSERT_TRUE(source_) << failure.error.text;
    info_ = Json::parse(source_->info());
  }
  static ShapeView all_of(std::uint32_t discs) {
    ShapeView view;
    view.discs = discs;
    return view;
  }
  SentShape shape_of(std::uint32_t discs) { return shape_of(all_of(discs)); }
  SentShape shape_of(const ShapeView& view) {
    std::string bytes;
    do {
      const auto shape = source_->shape(view);
      EXPECT_TRUE(shape) << shape.error().text;
      if (!shape) return SentShape(std::string(32, '\0'));
      bytes = *shape;
    } while (SentShape(bytes).complete == 0);
    return SentShape(bytes);
  }
  /// A point of the frame of an instance's file in the world, as the page places it.
  Vec3 placed(const Json& instance, const float* at) const {
    const octree::RigidTransform turn = *octree::RigidTransform::of(
        {{instance["rotation"][0], instance["rotation"][1], instance["rotation"][2],
          instance["rotation"][3]},
         {instance["offset"][0], instance["offset"][1], instance["offset"][2]}});
    const double scale = instance["scale"], unit = info_["unit"];
    const Vec3 point = turn.apply({at[0] * scale, at[1] * scale, at[2] * scale});
    return {point.x * unit + info_["centre"][0].get<double>(),
            point.y * unit + info_["centre"][1].get<double>(),
            point.z * unit + info_["centre"][2].get<double>()};
  }
  Json answer_at(const Vec3& point, double within = 0) {
    return settled_answer(*source_, {point, within});
  }

  std::unique_ptr<SceneSource> source_;
  Json info_;
};

TEST_F(SceneSourceTest, TellsInstancesAndWhatTheirModelsTake) {
  EXPECT_EQ(info_["file"], "scene.json");
  EXPECT_EQ(info_["triangles"], 4 + 4 + kTriangles);
  ASSERT_EQ(info_["instances"].size(), 3u);
  EXPECT_EQ(info_["instances"][1]["name"], "turned");
  EXPECT_EQ(info_["instances"][1]["model"], "solid");
  // A quarter turn about z takes the unit cube to x of -1 to 0.
  EXPECT_NEAR(info_["instances"][1]["box_lower"][0], 4, 1e-12);
  EXPECT_NEAR(info_["instances"][1]["box_upper"][1], 1, 1e-12);
  ASSERT_EQ(info_["models"].size(), 2u) << "one model has no instance";
  std::uint64_t sum = 0;
  for (const Json& model : info_["models"])
    sum += model["memory_bytes"]["total"].get<std::uint64_t>();
  EXPECT_EQ(info_["model_bytes"], sum);
  EXPECT_EQ(info_["models"][0]["instances"], 2);
  EXPECT_EQ(info_["models"][1]["layers"], Json({"distance"}));
  EXPECT_EQ(info_["memory_bytes"], 16 << 20);
  EXPECT_LE(
      info_["arena_bytes"].get<std::uint64_t>() + sum + info_["table_bytes"].get<std::uint64_t>(),
      16u << 20);
  EXPECT_EQ(source_->timeline(), "null\n");
  EXPECT_EQ(source_->pages(), "");
}

TEST_F(SceneSourceTest, PlacesAllTrianglesByTheirPoses) {
  const SentShape shape = shape_of(ShapeView::kMaxDiscs);
  EXPECT_EQ(shape.discs, 0u);
  ASSERT_EQ(shape.triangles_by_instance(3), (std::vector<std::size_t>{4, 4, kTriangles}));
  std::set<std::array<long, 3>> corners;  // of the instance that is turned
  for (const auto& words : shape.triangle_words) {
    const auto index = static_cast<std::size_t>(words[11]);
    for (std::size_t corner = 0; corner < 12; corner += 4) {
      const Vec3 at = placed(info_["instances"][index], words.data() + corner);
      const Json& instance = info_["instances"][index];
      EXPECT_GE(at.x, instance["box_lower"][0].get<double>() - 1e-4);
      EXPECT_LE(at.y, instance["box_upper"][1].get<double>() + 1e-4);
      if (index == 1)
        corners.insert(
            {std::lround(1000 * at.x), std::lround(1000 * at.y), std::lround(1000 * at.z)});
    }
  }
  EXPECT_EQ(corners, (std::set<std::array<long, 3>>{
                         {5000, 0, 0}, {5000, 1000, 0}, {4000, 0, 0}, {5000, 0, 1000}}));
}

TEST_F(SceneSourceTest, KeepsTheShapeToItsLimitAndTheRoots) {
  const SentShape shape = shape_of(60);
  EXPECT_LE(shape.discs + shape.triangles, 60u);
  EXPECT_EQ(shape.triangles_by_instance(3)[0], 4u) << "a root that is a block";
  const SentShape least = shape_of(1);
  EXPECT_GT(least.discs, 0u);
  EXPECT_EQ(least.triangles_by_instance(3)[1], 4u);
}

TEST_F(SceneSourceTest, ReadsPagesOnceForAllInstancesOfAFile) {
  open("one.json");
  const SentShape one = shape_of(ShapeView::kMaxDiscs);
  open("two.json");
  const SentShape two = shape_of(ShapeView::kMaxDiscs);
  EXPECT_EQ(two.triangles, 2 * one.triangles);
  EXPECT_EQ(two.pages_read, one.pages_read);
}

TEST_F(SceneSourceTest, IsFinerInTheInstanceNearTheEye) {
  open("two.json");
  for (const std::size_t near : {0U, 1U}) {
    const Json& box = info_["instances"][near];
    ShapeView view = all_of(200);
    view.has_eye = true;
    const auto in_frame = [&](std::size_t axis) {
      const double middle =
          0.5 * (box["box_lower"][axis].get<double>() + box["box_upper"][axis].get<double>());
      return (middle - info_["centre"][axis].get<double>()) / info_["unit"].get<double>();
    };
    view.eye = {in_frame(0), in_frame(1), in_frame(2)};
    view.look = {0, 0, 1};
    const auto counts = shape_of(view).triangles_by_instance(2);
    EXPECT_GT(counts[near], 2 * counts[1 - near]) << near;
  }
}

TEST_F(SceneSourceTest, AnswersWithTheInstance) {
  const Json inside = answer_at({0.1, 0.1, 0.1}, 0.2);
  EXPECT_EQ(inside["instance"], 0);
  EXPECT_EQ(inside["side"], "inside");
  EXPECT_EQ(inside["distance"], inside["contacts"][0]["distance"]);
  EXPECT_EQ(inside["contacts"].size(), 3u);
  EXPECT_EQ(inside["contacts"][2]["instance"], 0);
  const Json beside = answer_at({4.5, 0.25, -2});
  EXPECT_EQ(beside["instance"], 1);
  EXPECT_NEAR(beside["distance"], 2, 1e-9);
  EXPECT_NEAR(beside["normal"][2], -1, 1e-9);
  EXPECT_LE(beside["lower"], beside["distance"]);
  EXPECT_TRUE(beside["contacts"].empty());
}

// The part that the layer tells is left out, not awaited in vain.
TEST_F(SceneSourceTest, AnswersExactlyWithoutASideLayer) {
  EXPECT_EQ(answer_at({3, 103, 50})["side"], "outside") << "a sheet has sides without that layer";
  open("lean.json");
  const Json answer = answer_at({0.1, 0.1, -2}, 10);
  EXPECT_EQ(answer["instance"], 0);
  EXPECT_EQ(answer["side"], "unknown");
  EXPECT_EQ(answer["status"], "exact");
  EXPECT_TRUE(answer["normal"].is_null());
  EXPECT_EQ(answer_at({5.1, 0.1, -2})["side"], "outside");
}

TEST_F(SceneSourceTest, CountsThePagesOfAllModels) {
  const Json before = Json::parse(source_->stats());
  EXPECT_EQ(before["loaded"], before["resident"]);
  shape_of(ShapeView::kMaxDiscs);
  EXPECT_EQ(Json::parse(source_->stats())["loaded"], before["loaded"]) << "the picture reads none";
  answer_at({0.1, 0.1, 0.1});
  answer_at({3, 103, 50});
  const Json after = Json::parse(source_->stats());
  EXPECT_GE(after["loaded"], 2);
  EXPECT_EQ(after["loaded"].get<int>() - after["evicted"].get<int>(), after["resident"]);
  EXPECT_LE(after["resident"], after["frames"]);
}

TEST_F(SceneSourceTest, SaysWhichFileIsAtFault) {
  SceneFailure failure;
  EXPECT_FALSE(SceneSource::open("none.json", std::nullopt, failure));
  EXPECT_EQ(failure.file, "none.json");
  EXPECT_EQ(failure.error.code, ErrorCode::kNotFound);
  EXPECT_FALSE(SceneSource::open("scene.json", 1024, failure));
  EXPECT_EQ(failure.error.code, ErrorCode::kNoMemory);
  write("solid.ptree", "text");
  EXPECT_FALSE(SceneSource::open("scene.json", std::nullopt, failure));
  EXPECT_EQ(failure.file, "solid.ptree");
  EXPECT_EQ(failure.error.code, ErrorCode::kNotPlanetree);
}

TEST_F(SceneSourceTest, NamesTheFileOfADamagedPage) {
  flip("tree.ptree", entries_[1].offset + 5);
  const auto shape = source_->shape(all_of(ShapeView::kMaxDiscs));
  ASSERT_FALSE(shape);
  EXPECT_EQ(shape.error().page, 1u);
  EXPECT_NE(std::string(shape.error().text).find("tree.ptree"), std::string::npos);
}

TEST_F(SceneSourceTest, RefusesMoreInstancesThanThePageLists) {
  Json scene = {{"format", "planetree-scene"}, {"version", 1}};
  scene["models"]["solid"]["file"] = "solid.ptree";
  scene["instances"] = Json(SceneSource::kMaxInstances + 1, {{"model", "solid"}});
  write("more.json", scene.dump());
  SceneFailure failure;
  EXPECT_FALSE(SceneSource::open("more.json", std::nullopt, failure));
  EXPECT_EQ(failure.error.code, ErrorCode::kUnsupported);
  EXPECT_NE(std::string(failure.error.text).find("up to 4096"), std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
