#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/query/least_memory.h"
#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

const std::string kClosed = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/boxes.obj";
const std::string kOpen = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/tube.obj";
const std::string kSheet = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/sheet.obj";

/// The option --layers of the subcommands, and what inspect says of layers.
class CommandLayers : public Command {
 protected:
  static Json build(const std::string& mesh, const std::string& layers,
                    std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"build",   mesh,          "-o",     "layers.ptree",
                                       "--force", "--page-size", "4K",     "--layers",
                                       layers,    "--json",      "--quiet"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome result = run(arguments);
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
  static Json inspect() { return Json::parse(run({"inspect", "layers.ptree", "--json"}).output); }
  static Json row(const std::string& point, std::vector<std::string> options) {
    options.insert(options.begin(), {"query", "layers.ptree", "--format", "jsonl"});
    const Outcome result = run(options, point + "\n");
    EXPECT_EQ(result.status, 0) << result.errors;
    return Json::parse(result.output);
  }
};

TEST_F(CommandLayers, FilesWithoutLayersVerify) {
  for (const std::string& mesh : {kClosed, kOpen, kSheet})
    for (const char* layers : {"distance", "distance,side", "field", "side,field,distance"})
      for (const std::vector<std::string>& more :
           {std::vector<std::string>(), std::vector<std::string>{"--box=-6,-20,2,20,20,15"}}) {
        if (!more.empty() && mesh == kSheet) continue;
        build(mesh, layers, more);
        const Outcome result = run({"verify", "layers.ptree", "--full"});
        EXPECT_EQ(result.status, 0) << mesh << ' ' << layers << ": " << result.output;
      }
}

TEST_F(CommandLayers, BuildAndInspectNameThem) {
  const Json built = build(kOpen, "distance");
  EXPECT_EQ(built["layers"], Json({"distance"}));
  EXPECT_EQ(built["watertight"], false);
  const Json seen = inspect();
  EXPECT_EQ(seen["watertight"], false);
  EXPECT_EQ(seen["sign_rule"], "none");
  EXPECT_GT(seen["layers"]["distance"]["pages"], 0);
  EXPECT_TRUE(seen["layers"]["side"].is_null());
  EXPECT_TRUE(seen["layers"]["field"].is_null());
  const std::string text = run({"inspect", "layers.ptree"}).output;
  EXPECT_NE(text.find(", no side, no field\n"), std::string::npos) << text;
  EXPECT_NE(text.find("sides unknown without the side layer"), std::string::npos) << text;
  const Json why = Json::parse(run({"inspect", "layers.ptree", "--why", "1,1,1", "--json"}).output);
  EXPECT_EQ(why["rule"], "none");
  EXPECT_EQ(why["because"], "the file has no side layer");
}

TEST_F(CommandLayers, InspectSaysWhatLeavingThemOutSaves) {
  build(kOpen, "distance,side,field");
  const Json seen = inspect();
  const Json &layers = seen["layers"], &bytes = seen["bytes"];
  EXPECT_EQ(layers["distance"]["bytes"], bytes["distance_pages"]);
  EXPECT_EQ(layers["side"]["bytes"].get<int>(),
            bytes["cap_pages"].get<int>() + bytes["mask_pages"].get<int>());
  const auto least = [](std::uint32_t left_out) {
    OpenOptions options;
    options.max_probes = 1;
    options.layers = kAllLayers & ~left_out;
    return least_memory_bytes("layers.ptree", options);
  };
  EXPECT_EQ(layers["side"]["min_budget_saved_bytes"], least(0) - least(kSideLayer));
  EXPECT_GT(layers["side"]["min_budget_saved_bytes"], 0);
  OpenOptions options;
  options.max_probes = 1;
  const auto all = Model::open("layers.ptree", options);
  options.layers = kFieldLayer;
  const auto less = Model::open("layers.ptree", options);
  ASSERT_TRUE(all && less);
  EXPECT_EQ(layers["side"]["frame_bytes"], (all->stats().frames - less->stats().frames) * 4096);
  EXPECT_NE(run({"inspect", "layers.ptree"}).output.find("left out at open, side saves"),
            std::string::npos);
}

TEST_F(CommandLayers, QueryAnswersWhatTheyTell) {
  build(kClosed, "distance,side,field");
  const Json whole = row("1,1,1", {}), distance = row("1,1,1", {"--layers", "distance"});
  EXPECT_EQ(whole["side"], "inside");
  EXPECT_EQ(distance["distance"], whole["distance"]);
  EXPECT_EQ(distance["status"], "exact");
  EXPECT_FALSE(distance.contains("side"));
  EXPECT_EQ(row("1,1,1", {"--layers", "side"}), whole);
  const Json sided = row("1,1,1", {"--layers", "field", "--parts", "distance,side"});
  EXPECT_EQ(sided["side"], "unknown");
  EXPECT_EQ(sided["status"], "degraded");
  EXPECT_EQ(row("1,1,1", {"--layers", "field", "--contains"})["side"], "unknown");
  EXPECT_EQ(row("1,1,1", {"--layers", "field", "--side", "surface"})["side"], "inside");
  EXPECT_TRUE(row("1,1,1", {"--layers", "field", "--signed"})["signed_distance"].is_null());
}

TEST_F(CommandLayers, TradeAndTouchReportThem) {
  build(kOpen, "distance,side,field");
  const Outcome trade = run({"trade", "layers.ptree", "--json", "--count", "20", "--memory", "8M",
                             "--layers", "distance"});
  ASSERT_EQ(trade.status, 0) << trade.errors;
  const Json report = Json::parse(trade.output);
  ASSERT_GT(report["rows"].size(), 0u);
  for (const Json& each : report["rows"]) {
    EXPECT_EQ(each["layers"], Json({"distance"}));
    EXPECT_EQ(each["broken"], 0);
  }
  EXPECT_EQ(report["rows"][0]["exact_share"], 1);
  const Outcome touch = run({"touch", "layers.ptree", "--json", "--seconds", "1", "--rate", "20",
                             "--layers", "distance,field"});
  ASSERT_EQ(touch.status, 0) << touch.errors;
  const Json session = Json::parse(touch.output);
  EXPECT_EQ(session["layers"].back() == "side", false);
  EXPECT_EQ(session["unknown_sides"], session["ticks"]);
  EXPECT_LT(session["degraded"], session["ticks"]);
}

TEST_F(CommandLayers, RefusesOtherWords) {
  for (const char* text :
       {"", "sides", "distance,", ",side", "distance side", "all", "side,,field"})
    for (const std::vector<std::string>& start :
         {std::vector<std::string>{"build", "mesh.obj", "-o", "new.ptree"},
          std::vector<std::string>{"query", "tree.ptree"},
          std::vector<std::string>{"touch", "tree.ptree"},
          std::vector<std::string>{"trade", "tree.ptree"}}) {
      std::vector<std::string> arguments = start;
      arguments.push_back(std::string("--layers=") + text);
      const Outcome result = run(arguments);
      EXPECT_EQ(result.status, 2) << text;
      EXPECT_EQ(lines_of(result.errors).size(), 1u) << result.errors;
      if (*text == '\0') continue;
      EXPECT_NE(result.errors.find("distance, side, field"), std::string::npos) << result.errors;
    }
  EXPECT_FALSE(fs::exists("new.ptree"));
}

}  // namespace
}  // namespace planetree::tools
