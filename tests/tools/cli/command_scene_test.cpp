#include <gtest/gtest.h>

#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

class SceneCommand : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    build_sample("solid.obj", "solid.ptree");
    write("scene.json", R"({"format": "planetree-scene", "version": 1, "memory": "16M",
      "models": {"solid": {"file": "solid.ptree"},
                 "mesh": {"file": "tree.ptree", "layers": "distance"},
                 "unused": {"file": "solid.ptree", "layers": "distance,side"}},
      "instances": [{"model": "solid"},
                    {"name": "moved", "model": "solid", "translation": [5, 0, 0]},
                    {"model": "mesh", "translation": [0, 100, 0]}]})");
  }
  static Json json_of(const std::string& text) { return Json::parse(text); }
};

TEST_F(SceneCommand, ReportsWhatModelsTake) {
  const Outcome text = run({"scene", "scene.json"});
  EXPECT_EQ(text.status, 0) << text.errors;
  EXPECT_NE(text.output.find("scene.json: 3 instances of 2 models in 16.0 MiB"), std::string::npos)
      << text.output;
  EXPECT_NE(text.output.find("instance 1: moved, of solid"), std::string::npos);
  const Outcome result = run({"scene", "scene.json", "--json"});
  EXPECT_EQ(result.status, 0) << result.errors;
  const Json json = json_of(result.output);
  EXPECT_EQ(json["budget_bytes"], 16 << 20);
  ASSERT_EQ(json["models"].size(), 2u);
  std::uint64_t sum = 0;
  for (const Json& model : json["models"])
    sum += model["memory_bytes"]["total"].get<std::uint64_t>();
  EXPECT_EQ(json["model_bytes"], sum);
  EXPECT_EQ(json["models"][0]["instances"], 2);
  EXPECT_EQ(json["models"][0]["triangles"], 4);
  EXPECT_EQ(json["models"][0]["saved_bytes"], 0);
  EXPECT_TRUE(json["models"][0]["left_out"].empty());
  EXPECT_EQ(json["instances"][1]["name"], "moved");
}

// What is said to be saved is the difference to the report with all layers.
TEST_F(SceneCommand, TellsWhatLeavingLayersOutSaves) {
  const Json lean = json_of(run({"scene", "scene.json", "--json"}).output)["models"][1];
  std::string text = text_of("scene.json");
  text.replace(text.find(R"(, "layers": "distance"})"), 22, "");
  write("whole.json", text);
  const Json whole = json_of(run({"scene", "whole.json", "--json"}).output)["models"][1];
  EXPECT_EQ(lean["layers"], Json({"distance"}));
  ASSERT_FALSE(lean["left_out"].empty());
  EXPECT_GT(lean["saved_bytes"], 0);
  EXPECT_EQ(lean["saved_bytes"].get<std::uint64_t>(),
            whole["memory_bytes"]["total"].get<std::uint64_t>() -
                lean["memory_bytes"]["total"].get<std::uint64_t>());
}

// Pages of layers that are left out are never read, whatever is asked.
TEST_F(SceneCommand, ReadsNoPageThatIsLeftOut) {
  write("mesh.json", R"({"format": "planetree-scene", "version": 1,
    "models": {"mesh": {"file": "tree.ptree", "layers": "distance"}},
    "instances": [{"model": "mesh"}]})");
  const Json model = json_of(run({"scene", "mesh.json", "--json"}).output)["models"][0];
  std::uint64_t left_out = 0;
  for (const Json& layer : model["left_out"]) left_out += layer["pages"].get<std::uint64_t>();
  ASSERT_GT(left_out, 0u);
  std::string points;
  for (int i = 0; i < 400; ++i)
    points += std::to_string(i % 20) + "," + std::to_string(i / 20) + ",0.5\n";
  const Outcome result = run({"scene", "mesh.json", "-", "--json"}, points);
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_LE(json_of(result.errors)["pages_read"].get<std::uint64_t>(), entries_.size() - left_out);
}

TEST_F(SceneCommand, AnswersPointsWithTheInstance) {
  const std::string points = "0.1,0.1,0.1\n6,0.5,-1\n0,99,50\n";
  const Outcome result = run({"scene", "scene.json", "-"}, points);
  EXPECT_EQ(result.status, 0) << result.errors;
  std::istringstream lines(result.output);
  std::string header, inside, beside, far;
  std::getline(lines, header);
  std::getline(lines, inside);
  std::getline(lines, beside);
  std::getline(lines, far);
  EXPECT_TRUE(header.ends_with("feature,status,instance")) << header;
  EXPECT_NE(inside.find(",inside,"), std::string::npos) << inside;
  EXPECT_TRUE(inside.ends_with(",exact,0")) << inside;
  EXPECT_TRUE(beside.ends_with(",exact,1")) << beside;
  EXPECT_TRUE(far.ends_with(",2")) << far;
  // The first instance stands where its model is, so that its answers are those of the model.
  const Outcome alone = run({"query", "solid.ptree"}, "0.1,0.1,0.1\n");
  std::istringstream lines_alone(alone.output);
  std::getline(lines_alone, header);
  std::getline(lines_alone, header);
  EXPECT_EQ(inside, header + ",0");
  const Outcome beyond =
      run({"scene", "scene.json", "-", "--max-distance", "0.01", "--format", "jsonl"}, "3,3,3\n");
  EXPECT_EQ(json_of(beyond.output)["status"], "beyond_max_distance");
  EXPECT_TRUE(json_of(beyond.output)["instance"].is_null());
}

// Without the side layer an answer of all parts is degraded, one of the distance alone is exact.
TEST_F(SceneCommand, AnswersThePartsThatAreRequested) {
  const auto answer = [](const std::string& parts, const std::string& point) {
    const Outcome result =
        run({"scene", "scene.json", "-", "--parts", parts, "--format", "jsonl"}, point);
    EXPECT_EQ(result.status, 0) << result.errors;
    return json_of(result.output);
  };
  const Json distance = answer("distance", "3,100,2\n");
  EXPECT_EQ(distance["status"], "exact");
  EXPECT_EQ(distance["instance"], 2);
  EXPECT_TRUE(distance.contains("px"));
  EXPECT_FALSE(distance.contains("side") || distance.contains("nx"));
  EXPECT_EQ(answer("distance,side", "6,0.1,0.1\n")["side"], "outside");
  const Json all = answer("normal", "5.1,0.1,0.1\n");
  EXPECT_TRUE(all.contains("nx") && all.contains("distance"));
  EXPECT_EQ(all["side"], "inside");
  const Json side = answer("side", "5.1,0.1,0.1\n");
  EXPECT_EQ(side["side"], "inside");
  EXPECT_EQ(side["instance"], 1);
  EXPECT_FALSE(side.contains("distance"));
  EXPECT_EQ(run({"scene", "scene.json", "--parts", "side"}).status, 2);
  EXPECT_EQ(run({"scene", "scene.json", "-", "--parts", "triangle"}, "1,2,3\n").status, 2);
}

TEST_F(SceneCommand, ChoosesTheFormatByTheExtension) {
  EXPECT_EQ(run({"scene", "scene.json", "-", "-o", "out.jsonl"}, "1,2,3\n").status, 0);
  EXPECT_EQ(text_of("out.jsonl"),
            run({"scene", "scene.json", "-", "--format", "jsonl"}, "1,2,3\n").output);
  EXPECT_EQ(run({"scene", "scene.json", "-", "-o", "out.npy"}, "1,2,3\n").status, 2);
  EXPECT_FALSE(fs::exists("out.npy"));
}

TEST_F(SceneCommand, ShowsNoControlCharacters) {
  write("names.json", R"({"format": "planetree-scene", "version": 1,
    "models": {"a\u001b[31m": {"file": "solid.ptree"}},
    "instances": [{"model": "a\u001b[31m", "name": "x\ny"}]})");
  const Outcome result = run({"scene", "names.json"});
  EXPECT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output.find('\x1b'), std::string::npos);
  EXPECT_NE(result.output.find("instance 0: x?y, of a?[31m\n"), std::string::npos) << result.output;
}

TEST_F(SceneCommand, NamesTheFileAtFault) {
  write("bad.json", R"({"format": "planetree-scene", "version": 1,
    "models": {"a": {"file": "missing.ptree"}}, "instances": [{"model": "a"}]})");
  const Outcome missing = run({"scene", "bad.json"});
  EXPECT_EQ(missing.status, 2);
  EXPECT_TRUE(missing.errors.starts_with("planetree: missing.ptree: ")) << missing.errors;
  write("bad.json", "{");
  EXPECT_EQ(run({"scene", "bad.json"}).status, 1);
  EXPECT_EQ(run({"scene", "none.json"}).status, 2);
  EXPECT_EQ(run({"scene"}).status, 2);
  EXPECT_EQ(run({"scene", "scene.json", "--force"}).status, 2);
  const Outcome little = run({"scene", "scene.json", "--memory", "100K"});
  EXPECT_EQ(little.status, 3) << little.errors;
  const Outcome malformed = run({"scene", "scene.json", "-"}, "1,2,x\n");
  EXPECT_EQ(malformed.status, 1);
}

}  // namespace
}  // namespace planetree::tools
