#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "query/file/scale.h"
#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/picture/png_reader.h"
#include "tools/slice/slice_cut.h"
#include "tools/slice/slice_pages.h"
#include "tools/trace_file/trace_reader.h"

namespace planetree::tools {
namespace {

class SliceOverlay : public Command {
 protected:
  static Outcome draw(const std::vector<std::string>& more) {
    std::vector<std::string> words = {"inspect",  "tree.ptree", "--slice", "y=50%",  "--image",
                                      "tree.png", "--json",     "--quiet", "--force"};
    words.insert(words.end(), more.begin(), more.end());
    return run(words);
  }
  static Json drawn(const std::vector<std::string>& more) {
    const Outcome result = draw(more);
    EXPECT_EQ(result.status, 0) << result.errors;
    return result.status == 0 ? Json::parse(result.output) : Json();
  }
};

std::string hex(const Rgb& colour) {
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x", colour.red, colour.green, colour.blue);
  return text;
}

/// Number of pixels of each colour in the raster.
std::map<std::string, std::uint64_t> colours_of(const Json& report) {
  const ReadPng png = read_png("tree.png");
  const std::uint32_t left = report["raster"]["left"], top = report["raster"]["top"];
  std::map<std::string, std::uint64_t> counts;
  for (std::uint32_t row = 0; row < report["raster"]["height"]; ++row)
    for (std::uint32_t column = 0; column < report["raster"]["width"]; ++column)
      ++counts[hex(png.at(left + column, top + row))];
  return counts;
}

TEST_F(SliceOverlay, CellsHaveAColourForEachLevel) {
  const auto before = colours_of(drawn({}));
  const Json report = drawn({"--overlay", "cells"});
  EXPECT_EQ(report["overlays"], Json({"cells"}));
  auto counts = colours_of(report);
  const Json& cells = report["cells"];
  ASSERT_GT(cells.size(), 2u);
  EXPECT_EQ(cells[0]["count"], 1);
  for (std::size_t i = 0; i < cells.size(); ++i) {
    EXPECT_EQ(cells[i]["level"], i);
    EXPECT_GT(cells[i]["count"], 0);
    const std::string colour = cells[i]["colour"];
    EXPECT_FALSE(before.contains(colour));
    EXPECT_GT(counts[colour], 20u) << i;
  }
}

// The root's box begins at x = 0.
TEST_F(SliceOverlay, CellsAreWhereTheBoxesAre) {
  const Json report = drawn({"--overlay", "cells"});
  const double pixel = report["pixel_length"];
  const double first = report["raster"]["first_pixel"][0];
  const auto column = static_cast<std::uint32_t>((0 - first) / pixel + 0.5);
  const ReadPng png = read_png("tree.png");
  const std::uint32_t left = report["raster"]["left"], top = report["raster"]["top"];
  const std::uint32_t row = top + report["raster"]["height"].get<std::uint32_t>() / 2;
  int dark = 0;
  for (std::uint32_t i = column - 2; i <= column + 2; ++i)
    dark += png.at(left + i, row).green < 100 ? 1 : 0;
  EXPECT_GE(dark, 1);
  for (std::uint32_t i = 4; i + 4 < column; ++i) EXPECT_GT(png.at(left + i, row).green, 40) << i;
}

// Each pixel of a page is in the box of a subtree or a block of that page.
TEST_F(SliceOverlay, PagesAreThoseOfTheTree) {
  auto parts = FileParts::open("tree.ptree");
  ASSERT_TRUE(parts);
  const auto model = Model::open("tree.ptree");
  ASSERT_TRUE(model);
  const SliceRaster raster(model->info(), *SlicePlane::parse("y=50%"));
  const storage::ModelRecord& record = parts->header()->model;
  const SliceCut cut(raster, record);
  const auto map = page_map(*parts, cut, raster);
  ASSERT_TRUE(map);
  const query::Scale scale(record.scale_exponent);
  std::uint64_t checked = 0;
  for (const auto& [page, each] : pages_of(*map)) {
    ASSERT_LT(page, parts->first_cap_page());
    ASSERT_FALSE(parts->load_page(page));
    const octree::FrameHeader& head = parts->frame().header();
    if (page == 0) continue;
    for (std::size_t at = 0; at < map->pages.size(); ++at) {
      if (map->pages[at] != page) continue;
      const auto place = raster.centre(static_cast<std::uint32_t>(at % map->width),
                                       static_cast<std::uint32_t>(at / map->width));
      const auto in = scale.in(place);
      bool found = false;
      for (std::uint32_t i = 0; i < head.root_count; ++i) {
        const octree::FloatBox& box = parts->frame().node(i).box;
        bool holds = true;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double relative = in[static_cast<int>(axis)] - record.centre[axis];
          const double slack = scale.in(raster.pixel_length());
          holds = holds && relative >= static_cast<double>(box.lower[axis]) - slack &&
                  relative <= static_cast<double>(box.upper[axis]) + slack;
        }
        found = found || holds;
      }
      ASSERT_TRUE(found) << page << ' ' << at;
      ++checked;
    }
  }
  EXPECT_GT(checked, 1000u);
}

TEST_F(SliceOverlay, PagesHaveTheColoursThatTheReportSays) {
  const Json report = drawn({"--overlay", "pages"});
  auto counts = colours_of(report);
  ASSERT_GT(report["pages"].size(), 1u);
  for (const Json& page : report["pages"]) {
    EXPECT_GT(page["pixels"], 0);
    EXPECT_GT(counts[page["colour"]], 0u);
  }
}

TEST_F(SliceOverlay, NeighboursHaveDifferentColours) {
  PageMap map;
  map.width = 30;
  for (std::uint32_t row = 0; row < 2; ++row)
    for (std::uint32_t i = 0; i < 30; ++i)
      map.pages.push_back(row == 0 ? i : (i < 15 ? PageMap::kNone : (i + 12) % 30));
  const auto pages = pages_of(map);
  EXPECT_EQ(pages.size(), 30u);
  for (std::size_t at = 0; at < map.pages.size(); ++at) {
    const std::uint32_t one = map.pages[at];
    if (one == PageMap::kNone) continue;
    for (const std::size_t next : {at + 1, at + 30}) {
      if (next >= 60 || (next == at + 1 && next % 30 == 0)) continue;
      const std::uint32_t other = map.pages[next];
      if (other == PageMap::kNone || other == one) continue;
      EXPECT_NE(pages.at(one).colour, pages.at(other).colour) << one << ' ' << other;
    }
  }
}

TEST_F(SliceOverlay, WidthsAreThoseOfLimitedWork) {
  const Json wide = drawn({"--overlay", "width", "--max-work", "0"});
  ASSERT_EQ(wide["colour_bars"].size(), 1u);
  EXPECT_EQ(wide["colour_bars"][0]["quantity"], "interval_width");
  EXPECT_GT(wide["colour_bars"][0]["top_value"], 1);
  const Json exact = drawn({"--overlay", "width"});
  EXPECT_LT(exact["colour_bars"][0]["top_value"], 1e-10);
}

TEST_F(SliceOverlay, ResidencyCountsTheLookupsOfATrace) {
  ASSERT_EQ(run({"touch", "tree.ptree", "--seconds", "1", "--trace", "t.trace", "--deterministic"})
                .status,
            0);
  const Json report = drawn({"--overlay", "residency", "--trace", "t.trace"});
  auto reader = TraceReader::open("t.trace");
  ASSERT_TRUE(reader);
  std::map<std::uint32_t, std::uint64_t> lookups;
  std::vector<PageAccess> accesses(1000);
  for (;;) {
    const auto count = reader->read(accesses);
    ASSERT_TRUE(count);
    if (*count == 0) break;
    for (std::size_t i = 0; i < *count; ++i)
      if (accesses[i].query_kind <= PageAccess::Query::kContains &&
          accesses[i].event <= PageAccess::Event::kFetched)
        ++lookups[accesses[i].page];
  }
  std::uint64_t sum = 0;
  for (const Json& page : report["pages"]) {
    EXPECT_EQ(page["lookups"], lookups[page["page"]]) << page["page"];
    sum += page["lookups"].get<std::uint64_t>();
    EXPECT_EQ(page["colour"], hex(lookup_colour(lookup_class(page["lookups"]))));
  }
  EXPECT_GT(sum, 0u);
}

TEST_F(SliceOverlay, ResidencyRefusesTheTraceOfAnotherModel) {
  write_mesh("other.obj", 5);
  build_sample("other.obj", "other.ptree");
  ASSERT_EQ(
      run({"query", "other.ptree", "--trace", "o.trace", "-", "--quiet"}, "x,y,z\n1,1,1\n").status,
      0);
  const Outcome result = draw({"--overlay", "residency", "--trace", "o.trace"});
  EXPECT_EQ(result.status, 2);
  EXPECT_EQ(result.errors,
            "planetree: o.trace: it is the trace of another model; give one of this model\n");
}

TEST(LookupClass, IsThePowerOfTen) {
  EXPECT_EQ(lookup_class(0), 0u);
  EXPECT_EQ(lookup_class(1), 1u);
  EXPECT_EQ(lookup_class(9), 1u);
  EXPECT_EQ(lookup_class(10), 2u);
  EXPECT_EQ(lookup_class(UINT64_MAX), kLookupClasses - 1);
}

TEST_F(SliceOverlay, DiscsAreOfTheLevelThatIsGiven) {
  const Json report = drawn({"--overlay", "discs", "--level", "2"});
  EXPECT_EQ(report["discs"]["level"], 2);
  EXPECT_GT(report["discs"]["count"], 1);
  EXPECT_GT(colours_of(report)[report["discs"]["colour"]], 100u);
}

// A lying disc cut through its axis is a rectangle, as wide as the disc and as high as the slab.
TEST(SliceCut, CutsADiscThroughItsAxis) {
  ModelInfo info;
  info.core_lower = {-1, -1, -1};
  info.core_upper = {1, 1, 1};
  const SliceRaster raster(info, *SlicePlane::parse("y=0"));
  const SliceCut cut(raster, storage::ModelRecord{});
  const octree::FloatBox box{{-1, -1, -1}, {1, 1, 1}};
  const std::vector<Place> corners = cut.of(box, {{0, 0, 1}, -0.125f, 0.25f, 0.5f});
  ASSERT_GE(corners.size(), 4u);
  double left = 1e9, right = 0, top = 1e9, bottom = 0;
  for (const Place& place : corners) {
    left = std::min(left, place.x);
    right = std::max(right, place.x);
    top = std::min(top, place.y);
    bottom = std::max(bottom, place.y);
  }
  const double pixel = raster.pixel_length();
  EXPECT_NEAR((right - left) * pixel, 1.0, 0.01);
  EXPECT_NEAR((bottom - top) * pixel, 0.375, 1e-6);
  EXPECT_NEAR(raster.top() - top * pixel, 0.25, 1e-6);
  EXPECT_TRUE(cut.of({{-1, 0.5f, -1}, {1, 1, 1}}, {{0, 0, 1}, -1, 1, 1}).empty());
}

TEST_F(SliceOverlay, RefusesWhatDoesNotGoTogether) {
  const auto line = [](const std::vector<std::string>& more) {
    const Outcome result = draw(more);
    EXPECT_EQ(result.status, 2);
    return result.errors;
  };
  EXPECT_NE(line({"--overlay", "cells,none"}).find("'cells,none' is not a list of overlays"),
            std::string::npos);
  EXPECT_NE(line({"--overlay", "pages,residency"}).find("give one of them"), std::string::npos);
  EXPECT_NE(line({"--overlay", "discs"}).find("--overlay discs requires --level"),
            std::string::npos);
  EXPECT_NE(line({"--overlay", "cells", "--level", "2"}).find("--level requires --overlay discs"),
            std::string::npos);
  EXPECT_NE(line({"--overlay", "residency"}).find("requires --trace"), std::string::npos);
  EXPECT_NE(line({"--overlay", "cells", "--max-work", "2"}).find("requires --overlay width"),
            std::string::npos);
  const Outcome named = run({"inspect", "tree.ptree", "--slice", "z=1", "--image", "a.jpg"});
  EXPECT_EQ(named.status, 2);
  EXPECT_EQ(named.errors,
            "planetree: inspect: --image: 'a.jpg' is neither a .png nor a .svg; give a name that "
            "ends with one of these; see planetree inspect --help\n");
}

}  // namespace
}  // namespace planetree::tools
