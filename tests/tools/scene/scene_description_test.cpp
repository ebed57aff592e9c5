#include "tools/scene/scene_description.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <utility>

namespace planetree::tools {
namespace {

constexpr const char* kModels = R"("models": {"a": {"file": "a.ptree"}})";

std::string scene_with(const std::string& models, const std::string& instances,
                       const std::string& more = "") {
  return R"({"format": "planetree-scene", "version": 1, )" + more + models + R"(, "instances": [)" +
         instances + "]}";
}

std::string complaint_of(const std::string& text) {
  const auto scene = parse_scene(text, "folder");
  if (scene) return "none";
  EXPECT_EQ(scene.error().code, ErrorCode::kBadInput);
  return scene.error().text;
}

TEST(SceneDescription, ReadsTheSample) {
  std::ifstream file(PLANETREE_SOURCE_DIR "/format-spec/scene-v1/samples/table.json");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto scene = parse_scene(text, "folder");
  ASSERT_TRUE(scene) << scene.error().text;
  EXPECT_EQ(scene->memory_bytes, std::uint64_t{64} << 20);
  ASSERT_EQ(scene->models.size(), 2u);
  EXPECT_EQ(scene->models[0].name, "table");
  EXPECT_EQ(scene->models[0].file, "folder/table.ptree");
  EXPECT_EQ(scene->models[0].layers, kDistanceLayer);
  EXPECT_EQ(scene->models[1].layers, kAllLayers);
  ASSERT_EQ(scene->instances.size(), 3u);
  EXPECT_EQ(scene->instances[0].model, 0u);
  EXPECT_EQ(scene->instances[0].pose.rotation.w, 1);
  EXPECT_EQ(scene->instances[2].name, "right");
  EXPECT_EQ(scene->instances[2].model, 1u);
  EXPECT_EQ(scene->instances[2].pose.translation.z, 0.75);
  EXPECT_EQ(scene->instances[2].pose.rotation.z, 1);
  EXPECT_EQ(scene->instances[2].pose.rotation.w, 0);
}

TEST(SceneDescription, ReadsMotionsAndRotationsOfAnyLength) {
  const auto scene = parse_scene(
      scene_with(kModels, R"({"model": "a", "rotation": [3, 0, 0, 4], "velocity": [1, 2, 3],
                              "angular_velocity": [0, 0, 0.5]})",
                 R"("memory": 1048576, )"),
      "");
  ASSERT_TRUE(scene) << scene.error().text;
  EXPECT_EQ(scene->memory_bytes, 1048576u);
  EXPECT_EQ(scene->models[0].file, "a.ptree");
  const InstanceDescription& instance = scene->instances[0];
  EXPECT_EQ(instance.pose.rotation.w, 0.6);
  EXPECT_EQ(instance.pose.rotation.z, 0.8);
  EXPECT_EQ(instance.twist.linear.y, 2);
  EXPECT_EQ(instance.twist.angular.z, 0.5);
}

TEST(SceneDescription, SaysWhatIsWrongAndWhere) {
  const std::pair<std::string, std::string> cases[] = {
      {"[]", "the file is not an object"},
      {"{}", "the file has no key 'format'"},
      {R"({"format": "planetree-scene", "version": 2})", "has a 'version' that is not 1"},
      {R"({"format": "scene", "version": 1})", "another 'format'"},
      {scene_with(kModels, ""), "'instances' that are not a list of 1 to 1048576"},
      {scene_with(R"("models": {})", R"({"model": "a"})"), "at least one model"},
      {scene_with(kModels, R"({"model": "b"})"), "instances[0] names a model 'b'"},
      {scene_with(kModels, R"({"model": "a"}, {"model": 7})"),
       "instances[1] has a 'model' that is not a text"},
      {scene_with(kModels, R"({"model": "a", "position": [0, 0, 0]})"),
       "instances[0] has a key 'position'"},
      {scene_with(kModels, R"({"model": "a", "translation": [0, 0]})"), "3 finite numbers"},
      {scene_with(kModels, R"({"model": "a", "rotation": [0, 0, 0, 0]})"), "1e-150 to 1e150"},
      {scene_with(kModels, R"({"model": "a", "translation": [1e200, 0, 0]})"), "above 2^500"},
      {scene_with(kModels, R"({"model": "a", "rotation": [1, 0, 0, "0"]})"), "4 finite numbers"},
      {scene_with(R"("models": {"a": {"file": ""}})", R"({"model": "a"})"), "models.a has no file"},
      {scene_with(R"("models": {"a": {"file": "a", "layers": "distances"}})", R"({"model": "a"})"),
       "models.a has 'layers'"},
      {scene_with(kModels, R"({"model": "a"})", R"("memory": "much", )"), "'memory'"},
      {scene_with(kModels, R"({"model": "a"})", R"("memory": -1, )"), "'memory'"},
      {scene_with(kModels, R"({"model": "a", "translation": [1e999, 0, 0]})"), "out of range"},
      {std::string(100000, '['), "nested too deeply"},
  };
  for (const auto& [text, complaint] : cases)
    EXPECT_NE(complaint_of(text).find(complaint), std::string::npos) << text.substr(0, 200) << "\n"
                                                                     << complaint_of(text);
}

TEST(SceneDescription, NamesThePlaceThatIsNotJson) {
  const auto scene = parse_scene("{\n\"format\": planetree}", "");
  ASSERT_FALSE(scene);
  EXPECT_EQ(scene.error().offset, 12u);
  EXPECT_TRUE(std::string(scene.error().text).starts_with("line 2, column 11: not JSON"))
      << scene.error().text;
}

}  // namespace
}  // namespace planetree::tools
