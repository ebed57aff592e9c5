#include "tools/command.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "tests/tools/cli/command_fixture.h"
#include "tools/cli/file_text.h"

namespace planetree::tools {
namespace {

TEST_F(Command, InspectReportsSizesThatAddUp) {
  const Outcome result = run({"inspect", "tree.ptree", "--json", "--levels", "--pages"});
  ASSERT_EQ(result.status, 0) << result.errors;
  const Json report = Json::parse(result.output);
  EXPECT_EQ(report["triangles"], kTriangles);
  EXPECT_EQ(report["vertices"], 225);
  EXPECT_EQ(report["box"]["upper"][0], 14.0);
  EXPECT_EQ(report["file_bytes"], fs::file_size("tree.ptree"));
  std::uint64_t sum = 0;
  for (const char* section : {"headers", "directory", "distance_pages", "cap_pages", "field_pages",
                              "mask_pages", "extensions"})
    sum += report["bytes"][section].get<std::uint64_t>();
  EXPECT_EQ(sum, fs::file_size("tree.ptree"));
  std::uint64_t nodes = 0, triangles = 0, in_pages = 0, raw = 0, streams = 0;
  for (const Json& level : report["by_level"]) {
    nodes += level["nodes"].get<std::uint64_t>();
    triangles += level["triangles"].get<std::uint64_t>();
  }
  for (const Json& page : report["by_page"]) {
    if (page["kind"] == "distance") in_pages += page["triangles"].get<std::uint64_t>();
    raw += page["raw_bytes"].get<std::uint64_t>();
  }
  for (const auto& [name, bytes] : report["bytes"]["within_pages"].items())
    streams += bytes.get<std::uint64_t>();
  EXPECT_EQ(nodes, report["nodes"]);
  EXPECT_EQ(triangles, kTriangles);
  EXPECT_EQ(in_pages, kTriangles);
  EXPECT_EQ(streams, raw);
  EXPECT_EQ(report["by_page"].size(), report["pages"]);
}

TEST_F(Command, InspectListsTheStreamsOfMaskPages) {
  const std::string boxes = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/boxes.ptree";
  const Json report = Json::parse(run({"inspect", boxes, "--json", "--pages"}).output);
  std::uint64_t raw = 0, streams = 0;
  for (const Json& page : report["by_page"]) raw += page["raw_bytes"].get<std::uint64_t>();
  for (const auto& [name, bytes] : report["bytes"]["within_pages"].items())
    streams += bytes.get<std::uint64_t>();
  EXPECT_EQ(streams, raw);
  const std::string last = std::to_string(report["pages"].get<int>() - 1);
  const Json page = Json::parse(run({"inspect", boxes, "--page", last, "--json"}).output);
  EXPECT_EQ(page["streams"].size(), 1u + 22u);
  std::uint64_t end = 0;
  for (const Json& stream : page["streams"]) {
    EXPECT_EQ(stream["offset"], end) << stream;
    end += stream["bytes"].get<std::uint64_t>();
  }
  EXPECT_EQ(end, page["entry"]["raw_bytes"]);
  EXPECT_EQ(page["streams"].back()["elements"], page["head"]["block_link_count"]);
  EXPECT_GT(report["lists_of_blocks"], 0);
}

TEST_F(Command, InspectCountsHeightFields) {
  const std::string samples = PLANETREE_SOURCE_DIR "/format-spec/v1/samples/";
  const auto report = [&](const std::string& file) {
    return Json::parse(run({"inspect", file, "--json"}).output);
  };
  const Json sphere = report(samples + "sphere.ptree");
  EXPECT_EQ(sphere["height_field_blocks"], sphere["blocks"]);
  const Json boxes = report(samples + "boxes.ptree");
  EXPECT_GT(boxes["height_field_blocks"], 0);
  EXPECT_LT(boxes["height_field_blocks"], boxes["blocks"]);
  EXPECT_EQ(report("tree.ptree")["height_field_blocks"], 0);
  const std::string text = run({"inspect", samples + "sphere.ptree"}).output;
  const std::string blocks = sphere["blocks"].dump();
  EXPECT_NE(text.find(blocks + " blocks, " + blocks + " of them height fields"), std::string::npos)
      << text;
}

TEST_F(Command, InspectReportsWatertightness) {
  const Json open = Json::parse(run({"inspect", "tree.ptree", "--json"}).output);
  EXPECT_EQ(open["watertight"], false);
  EXPECT_EQ(open["sign_rule"], "surface");
  EXPECT_EQ(open["sign_rule_is_chosen"], false);
  EXPECT_GT(open["openness"], 0.375);
  EXPECT_EQ(open["unbalanced_edges"], 4 * kSide);
  ASSERT_EQ(open["first_unbalanced_edges"].size(), 3u);
  EXPECT_EQ(open["first_unbalanced_edges"][0]["triangle"], 0);
  EXPECT_EQ(open["first_unbalanced_edges"][0]["along"], 1);
  EXPECT_EQ(open["first_unbalanced_edges"][0]["against"], 0);
  const std::string text = run({"inspect", "tree.ptree"}).output;
  EXPECT_NE(text.find("not watertight; sides by the nearest face"), std::string::npos) << text;
  EXPECT_NE(text.find("in triangle 0: 1 faces that way, 0 the other"), std::string::npos) << text;
  write("solid.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  build_sample("solid.obj", "solid.ptree");
  const Json closed = Json::parse(run({"inspect", "solid.ptree", "--json"}).output);
  EXPECT_EQ(closed["watertight"], true);
  EXPECT_EQ(closed["sign_rule"], "crossings");
  EXPECT_EQ(closed["openness"], 0);
  EXPECT_EQ(closed["first_unbalanced_edges"], Json::array());
}

TEST_F(Command, InspectContinuesInADamagedFile) {
  flip("tree.ptree", entries_[2].offset);
  const Outcome plain = run({"inspect", "tree.ptree", "--pages"});
  EXPECT_EQ(plain.status, 1);
  EXPECT_NE(plain.output.find("unreadable"), std::string::npos);
  EXPECT_NE(plain.output.find("392 triangles"), std::string::npos);
  EXPECT_TRUE(plain.errors.starts_with("planetree: tree.ptree: PAGE_CHECKSUM: page 2, at byte "));
  const Outcome page = run({"inspect", "tree.ptree", "--page", "2"});
  EXPECT_EQ(page.status, 1);
  EXPECT_NE(page.output.find("stored_bytes"), std::string::npos);
  const Outcome json = run({"inspect", "tree.ptree", "--json"});
  EXPECT_EQ(json.status, 1);
  EXPECT_EQ(Json::parse(json.output)["issues"][0]["code"], "PAGE_CHECKSUM");
}

TEST_F(Command, InspectShowsOnePage) {
  const Outcome result = run({"inspect", "tree.ptree", "--page", "0", "--json"});
  ASSERT_EQ(result.status, 0) << result.errors;
  const Json page = Json::parse(result.output);
  EXPECT_EQ(page["entry"]["offset"],
            storage::kHeaderBytes + storage::kDirectoryEntryBytes * entries_.size());
  EXPECT_EQ(page["head"]["page_number"], 0);
  std::uint64_t bytes = 0;
  for (const Json& stream : page["streams"]) {
    EXPECT_EQ(stream["offset"], bytes);
    bytes += stream["bytes"].get<std::uint64_t>();
  }
  EXPECT_EQ(page["entry"]["raw_bytes"], bytes);
  EXPECT_EQ(page["nodes"].size(), page["head"]["node_count"]);
}

TEST_F(Command, InspectFindsNodesByOctcode) {
  const std::string shown = cell_text(entries_[0].octcode);
  std::string typed = shown;
  std::replace(typed.begin(), typed.end(), '/', ':');
  for (const std::string& cell : {shown, typed, fmt::format("{:#x}", entries_[0].octcode)}) {
    const Outcome result = run({"inspect", "tree.ptree", "--node", cell, "--json"});
    ASSERT_EQ(result.status, 0) << cell << result.errors;
    const Json found = Json::parse(result.output);
    EXPECT_EQ(found["pages"][0]["page"], 0);
    EXPECT_GE(found["pages"][0]["nodes"][0]["children"].size(), 2u);
    EXPECT_TRUE(found["pages"][0]["nodes"][0].contains("box_lower"));
  }
}

// The model is long, so the image has few pixels.
TEST_F(Command, InspectDrawsASlice) {
  write("rod.obj", "v 0 0 0\nv 64 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  build_sample("rod.obj", "rod.ptree");
  const std::vector<std::string> draw = {"inspect", "rod.ptree", "--slice", "z=25%",
                                         "--image", "slice.png", "--json"};
  const Outcome result = run(draw);
  ASSERT_EQ(result.status, 0) << result.errors;
  const Json report = Json::parse(result.output);
  EXPECT_EQ(report["raster"]["width"], 800);
  EXPECT_EQ(report["raster"]["height"], 122);
  EXPECT_EQ(report["coordinate"], 0.25);
  EXPECT_EQ(storage::read_bytes("slice.png")[1], std::byte{'P'});
  EXPECT_EQ(run(draw).status, 2);
}

TEST_F(Command, InspectWarnsOfASliceBesideTheModel) {
  const auto errors_of = [](const std::string& plane) {
    const Outcome result = run(
        {"inspect", "tree.ptree", "--slice", plane, "--image", "slice.png", "--quiet", "--force"});
    EXPECT_EQ(result.status, 0) << result.errors;
    return result.errors;
  };
  EXPECT_EQ(errors_of("x=7"), "");
  EXPECT_TRUE(errors_of("x=99").starts_with(
      "planetree: warning: tree.ptree: the plane x=99 is outside of the model's box, where x is "
      "from 0 to 14; "))
      << errors_of("x=99");
}

TEST_F(Command, VerifyListsIssuesAndFails) {
  const Outcome well = run({"verify", "tree.ptree", "--full", "--json"});
  EXPECT_EQ(well.status, 0);
  EXPECT_EQ(Json::parse(well.output)["issues"], Json::array());
  const std::uint64_t offset = entries_[1].offset;
  flip("tree.ptree", offset);
  const Outcome damaged = run({"verify", "tree.ptree", "--json"});
  EXPECT_EQ(damaged.status, 1);
  EXPECT_EQ(damaged.errors, "");
  const Json issue = Json::parse(damaged.output)["issues"][0];
  EXPECT_EQ(issue["code"], "PAGE_CHECKSUM");
  EXPECT_EQ(issue["page"], 1);
  EXPECT_EQ(issue["offset"], offset);
  const Outcome plain = run({"verify", "tree.ptree"});
  EXPECT_TRUE(plain.output.starts_with("tree.ptree: PAGE_CHECKSUM: page 1, at byte "));
}

TEST_F(Command, InspectWritesAPageBesideItsReport) {
  const Outcome plain = run({"inspect", "tree.ptree"});
  const Outcome result = run({"inspect", "tree.ptree", "--html", "page.html"});
  ASSERT_EQ(result.status, 0) << result.errors;
  EXPECT_EQ(result.output, plain.output);
  const std::string page = text_of("page.html");
  EXPECT_NE(page.find("planetree inspect tree.ptree --html page.html --force"), std::string::npos);
  EXPECT_EQ(run({"inspect", "tree.ptree", "--html", "page.html"}).status, 2) << "it exists";
  EXPECT_EQ(run({"inspect", "tree.ptree", "--html", "page.html", "--force"}).status, 0);
  EXPECT_EQ(run({"inspect", "tree.ptree", "--html", "tree.ptree", "--force"}).status, 2);
  const char* const piped =
      PLANETREE_COMMAND " inspect tree.ptree --html - --pages >piped.html 2>report.txt";
  ASSERT_EQ(std::system(piped), 0);
  EXPECT_TRUE(text_of("piped.html").starts_with("<!DOCTYPE html>"));
  EXPECT_TRUE(text_of("piped.html").ends_with("</html>\n"));
  EXPECT_NE(text_of("report.txt").find("content id"), std::string::npos);
  EXPECT_EQ(run({"inspect", "tree.ptree", "--html", "x.html", "--page", "0"}).status, 2);
  EXPECT_EQ(run({"inspect", "tree.ptree", "--force"}).status, 2);
}

TEST_F(Command, InspectWritesAPageOfADamagedFile) {
  flip("tree.ptree", entries_[1].offset);
  const Outcome result = run({"inspect", "tree.ptree", "--json", "--html", "page.html"});
  EXPECT_EQ(result.status, 1);
  EXPECT_EQ(Json::parse(result.output)["issue_count"], 1);
  EXPECT_NE(text_of("page.html").find(">PAGE_CHECKSUM</th>"), std::string::npos);
}

}  // namespace
}  // namespace planetree::tools
