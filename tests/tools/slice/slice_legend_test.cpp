#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/cli/command_fixture.h"
#include "tests/tools/picture/png_reader.h"

// What a program reads from a picture alone: pixels and metadata of the PNG file.
namespace planetree::tools {
namespace {

/// A place of a picture and the values that its colour may have.
struct ReadPlace {
  double at[3];
  double lower, upper;
};

class PictureReader {
 public:
  explicit PictureReader(const fs::path& path)
      : png_(read_png(path)), facts_(Json::parse(png_.texts.at("planetree"))) {}

  const Json& facts() const { return facts_; }
  std::uint32_t width() const { return number("width"); }
  std::uint32_t height() const { return number("height"); }

  /// Empty if the colour is that of a line.
  std::optional<ReadPlace> read(std::uint32_t column, std::uint32_t row) const {
    const Json& raster = facts_["raster"];
    const Rgb colour = png_.at(raster["left"].get<std::uint32_t>() + column,
                               raster["top"].get<std::uint32_t>() + row);
    const auto values = values_of(colour);
    if (!values) return std::nullopt;
    ReadPlace place{{}, values->first, values->second};
    const double pixel = facts_["pixel_length"];
    for (std::size_t i = 0; i < 3; ++i) place.at[i] = raster["first_pixel"][i];
    place.at[axis(raster["right_axis"])] += column * pixel;
    place.at[axis(raster["up_axis"])] -= row * pixel;
    return place;
  }

 private:
  std::uint32_t number(const char* key) const { return facts_["raster"][key]; }
  static std::size_t axis(const Json& name) {
    return std::string("xyz").find(name.get<std::string>());
  }

  // The values between which the colour bar has a colour: looked up in the bar's pixels, of which
  // the first is at the top value and the last at the bottom value.
  std::optional<std::pair<double, double>> values_of(const Rgb& colour) const {
    for (const Json& bar : facts_["colour_bars"]) {
      const std::uint32_t left = bar["left"], top = bar["top"], height = bar["height"];
      std::optional<std::uint32_t> first, last;
      for (std::uint32_t i = 0; i < height; ++i)
        if (png_.at(left + bar["width"].get<std::uint32_t>() / 2, top + i) == colour) {
          if (!first) first = i;
          last = i + 1;
        }
      const double upper = bar["top_value"], span = upper - bar["bottom_value"].get<double>();
      if (first) return std::pair(upper - span * *last / height, upper - span * *first / height);
    }
    return std::nullopt;
  }

  ReadPng png_;
  Json facts_;
};

/// Signed distances as `planetree query` gives them, in the order of the places.
std::vector<double> query_places(const std::string& file, const std::vector<ReadPlace>& places) {
  std::string points = "x,y,z\n";
  for (const ReadPlace& place : places) {
    std::ostringstream line;
    line.precision(17);
    line << place.at[0] << ',' << place.at[1] << ',' << place.at[2] << '\n';
    points += line.str();
  }
  std::ofstream("places.csv") << points;
  const Outcome result = run({"query", file, "places.csv", "--quiet"});
  EXPECT_EQ(result.status, 0) << result.errors;
  const auto fields_of = [](const std::string& line) {
    std::vector<std::string> fields;
    std::istringstream stream(line);
    for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
    return fields;
  };
  const auto lines = lines_of(result.output);
  std::map<std::string, std::size_t> column;
  for (const std::string& name : fields_of(lines.at(0))) column.emplace(name, column.size());
  std::vector<double> found;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto fields = fields_of(lines[i]);
    const double distance = std::stod(fields.at(column.at("distance")));
    found.push_back(fields.at(column.at("side")) == "inside" ? -distance : distance);
  }
  return found;
}

/// Ten places whose colours are in the bar, along a diagonal from the upper left corner and from
/// the middle of the picture: outside, inside and near the surface.
std::vector<ReadPlace> ten_places(const PictureReader& picture) {
  std::vector<ReadPlace> places;
  for (std::uint32_t i = 0; i < 10; ++i) {
    std::uint32_t column = picture.width() * (2 * i + 1) / 20;
    const std::uint32_t row = picture.height() * (2 * i + 1) / 20;
    auto place = picture.read(column, row);
    while (!place && column + 1 < picture.width()) place = picture.read(++column, row);
    if (place) places.push_back(*place);
  }
  return places;
}

class SliceLegend : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    ASSERT_EQ(run({"generate", "ball.ply", "--shape", "statue", "--triangles", "5K"}).status, 0);
    ASSERT_EQ(run({"build", "ball.ply", "-o", "ball.ptree", "--quiet"}).status, 0);
  }
};

TEST_F(SliceLegend, GivesTheValuesOfQueryAtTenPlaces) {
  for (const char* plane : {"z=50%", "y=30%", "x=60%"}) {
    ASSERT_EQ(
        run({"inspect", "ball.ptree", "--slice", plane, "--image", "ball.png", "--force"}).status,
        0);
    const PictureReader picture("ball.png");
    const std::vector<ReadPlace> places = ten_places(picture);
    ASSERT_EQ(places.size(), 10u);
    const std::vector<double> found = query_places("ball.ptree", places);
    ASSERT_EQ(found.size(), 10u);
    const double pixel = picture.facts()["pixel_length"];
    const double band = picture.facts()["line_distance"];
    int inside = 0, outside = 0, near = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      // No more than the error of the pixel's distance and of the bar's pixels beyond the band.
      EXPECT_GE(found[i], places[i].lower - pixel / 2 - band / 20) << plane << ' ' << i;
      EXPECT_LE(found[i], places[i].upper + pixel / 2 + band / 20) << plane << ' ' << i;
      EXPECT_NEAR(places[i].upper - places[i].lower, band, band / 10);
      (found[i] < 0 ? inside : outside) += 1;
      near += std::fabs(found[i]) < band ? 1 : 0;
    }
    EXPECT_GE(inside, 3);
    EXPECT_GE(outside, 2);
    EXPECT_GE(near, 1);
  }
}

TEST_F(SliceLegend, IsTheSameInReportAndFile) {
  const Outcome result = run(
      {"inspect", "ball.ptree", "--slice", "z=50%", "--image", "ball.png", "--json", "--quiet"});
  Json report = Json::parse(result.output);
  const ReadPng png = read_png("ball.png");
  EXPECT_EQ(report["image"], "ball.png");
  EXPECT_EQ(report["width"], png.width);
  EXPECT_EQ(report["height"], png.height);
  report.erase("image");
  EXPECT_EQ(report, Json::parse(png.texts.at("planetree")));
  for (const Json& band : report["colour_bars"][0]["bands"]) {
    const double middle = (band["lower"].get<double>() + band["upper"].get<double>()) / 2;
    const std::string colour = band["colour"];
    const int red = std::stoi(colour.substr(1, 2), nullptr, 16);
    const int blue = std::stoi(colour.substr(5, 2), nullptr, 16);
    EXPECT_EQ(middle > 0, blue > red) << colour;
  }
  ASSERT_EQ(run({"inspect", "ball.ptree", "--slice", "z=50%", "--image", "ball.svg"}).status, 0);
  const std::string svg = text_of("ball.svg");
  EXPECT_NE(svg.find("&quot;first_pixel&quot;"), std::string::npos);
  EXPECT_NE(svg.find("<title id='title'>ball.ptree, z = "), std::string::npos);
}

// Without the side layer no side is known.
TEST_F(SliceLegend, IsGreyWhereTheSideIsUnknown) {
  ASSERT_EQ(
      run({"build", "ball.ply", "-o", "plain.ptree", "--layers", "distance", "--quiet"}).status, 0);
  ASSERT_EQ(run({"inspect", "plain.ptree", "--slice", "z=50%", "--image", "plain.png"}).status, 0);
  const PictureReader picture("plain.png");
  ASSERT_EQ(picture.facts()["colour_bars"].size(), 1u);
  EXPECT_EQ(picture.facts()["colour_bars"][0]["quantity"], "distance_of_unknown_side");
  const std::vector<ReadPlace> places = ten_places(picture);
  ASSERT_EQ(places.size(), 10u);
  for (const double distance : query_places("plain.ptree", places)) EXPECT_GE(distance, 0);
  EXPECT_GE(places[0].lower, 0);
}

// An open sheet has a front and a back.
TEST_F(SliceLegend, HasBothSidesOfASheet) {
  ASSERT_EQ(run({"inspect", "tree.ptree", "--slice", "y=50%", "--image", "sheet.png"}).status, 0);
  const PictureReader picture("sheet.png");
  const Json& bar = picture.facts()["colour_bars"][0];
  EXPECT_LT(bar["bottom_value"], 0);
  EXPECT_GT(bar["top_value"], 0);
  const auto above = picture.read(picture.width() / 2, 2);
  const auto below = picture.read(picture.width() / 2, picture.height() - 3);
  ASSERT_TRUE(above && below);
  EXPECT_NE(above->lower < 0, below->lower < 0);
}

}  // namespace
}  // namespace planetree::tools
