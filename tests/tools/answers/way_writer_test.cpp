#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>
#include <string>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/cli/captured_console.h"
#include "tools/answers/answer_writer.h"
#include "tools/points/row_reader.h"

// Answers about rays and sweeps in all formats.
namespace planetree::tools {
namespace {

constexpr double kEndless = std::numeric_limits<double>::infinity();
constexpr Ray kRay{{1, 2, 0.1}, {0, 0, -1}, 0.5, kEndless};
constexpr Sweep kSweep{{1, 2, 3}, {4, 5, 6}, 0.1};

RayHit sample_hit() {
  RayHit hit;
  hit.t = 0.75;
  hit.t_lower = 0.5;
  hit.t_upper = 1.0 / 3;
  hit.point = {7, 8, 9};
  hit.normal = {0, -1, 0};
  hit.triangle = 12345678901234;
  hit.entering = true;
  hit.status = Status::kExact;
  return hit;
}

FirstContact sample_contact() {
  FirstContact contact;
  contact.t = 0.75;
  contact.t_lower = 0.5;
  contact.at.point = {7, 8, 9};
  contact.at.normal = {0, -1, 0};
  contact.at.triangle = 5;
  contact.at.feature = Feature::kEdge;
  contact.status = Status::kDegraded;
  return contact;
}

template <class Query, class Answer>
std::string written_ways(const AnswerForm& form, const std::vector<Query>& queries,
                         const std::vector<Answer>& answers, bool with_header = false) {
  CapturedConsole captured;
  auto output = AnswerOutput::open("-", false, captured.console());
  AnswerWriter writer(*output, form);
  if (with_header) {
    EXPECT_TRUE(writer.begin(Answer()));
  }
  EXPECT_TRUE(writer.write(std::span<const Query>(queries), std::span<const Answer>(answers)));
  return captured.output();
}

AnswerForm way_form(AnswerFormat format, bool shows_range = false) {
  AnswerForm form;
  form.format = format;
  form.shows_range = shows_range;
  return form;
}

std::vector<double> raw_numbers_of(const std::string& bytes) {
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
  return numbers;
}

TEST(WayWriter, WritesTheColumnsOfTheInputFirst) {
  const std::vector rays{kRay};
  EXPECT_EQ(written_ways(way_form(AnswerFormat::kCsv), rays, std::vector{sample_hit()}, true),
            "x,y,z,dx,dy,dz,t,t_lower,t_upper,px,py,pz,nx,ny,nz,triangle,entering,status\n"
            "1,2,0.1,0,0,-1,0.75,0.5,0.3333333333333333,7,8,9,0,-1,0,12345678901234,1,exact\n");
  EXPECT_EQ(written_ways(way_form(AnswerFormat::kCsv, true), rays, std::vector{sample_hit()}, true),
            "x,y,z,dx,dy,dz,t_min,t_max,t,t_lower,t_upper,px,py,pz,nx,ny,nz,triangle,entering,"
            "status\n1,2,0.1,0,0,-1,0.5,inf,0.75,0.5,0.3333333333333333,7,8,9,0,-1,0,"
            "12345678901234,1,exact\n");
  EXPECT_EQ(written_ways(way_form(AnswerFormat::kCsv), std::vector{kSweep},
                         std::vector{sample_contact()}, true),
            "x0,y0,z0,x1,y1,z1,radius,t,t_lower,t_upper,px,py,pz,nx,ny,nz,triangle,feature,"
            "status\n1,2,3,4,5,6,0.1,0.75,0.5,inf,7,8,9,0,-1,0,5,edge,degraded\n");
}

TEST(WayWriter, LeavesFieldsOfNoTriangleEmpty) {
  const std::vector rays{kRay};
  const std::vector<RayHit> none(1);
  EXPECT_EQ(written_ways(way_form(AnswerFormat::kCsv), rays, none),
            "1,2,0.1,0,0,-1,inf,inf,inf,,,,,,,,,bad_query\n");
  const auto json =
      nlohmann::json::parse(written_ways(way_form(AnswerFormat::kJsonLines), rays, none));
  for (const char* key : {"t", "px", "nz", "triangle", "entering"})
    EXPECT_EQ(json.at(key), nullptr) << key;
  const auto numbers = raw_numbers_of(written_ways(way_form(AnswerFormat::kF64), rays, none));
  ASSERT_EQ(numbers.size(), 20u);
  EXPECT_EQ(numbers[8], kEndless);
  for (std::size_t i = 11; i < 19; ++i) EXPECT_TRUE(std::isnan(numbers[i])) << i;
  EXPECT_EQ(
      written_ways(way_form(AnswerFormat::kCsv), std::vector{kSweep}, std::vector<FirstContact>(1)),
      "1,2,3,4,5,6,0.1,inf,0,inf,,,,,,,,,bad_query\n");
}

TEST(WayWriter, WritesJsonAndRawNumbers) {
  const std::vector rays{kRay};
  const auto json = nlohmann::json::parse(
      written_ways(way_form(AnswerFormat::kJsonLines, true), rays, std::vector{sample_hit()}));
  EXPECT_EQ(json["t_min"], 0.5);
  EXPECT_EQ(json["t_max"], nullptr);
  EXPECT_EQ(json["entering"], true);
  EXPECT_EQ(json["triangle"], 12345678901234);
  EXPECT_EQ(
      raw_numbers_of(written_ways(way_form(AnswerFormat::kF64), rays, std::vector{sample_hit()})),
      (std::vector<double>{1,       2, 0.1, 0, 0, -1, 0.5, kEndless,       0.75, 0.5,
                           1.0 / 3, 7, 8,   9, 0, -1, 0,   12345678901234, 1,    0}));
  EXPECT_EQ(raw_numbers_of(written_ways(way_form(AnswerFormat::kF64), std::vector{kSweep},
                                        std::vector{sample_contact()})),
            (std::vector<double>{1, 2, 3, 4, 5, 6, 0.1, 0.75, 0.5, kEndless, 7, 8, 9, 0, -1, 0, 5,
                                 1, 2}));
}

// Rows of answers begin with the columns of the input, so that they are an input again.
TEST(WayWriter, WritesRowsThatAreReadAgain) {
  const storage::TemporaryDirectory folder;
  std::mt19937_64 random(17);
  std::vector<Ray> rays;
  while (rays.size() < 500) {
    std::array<double, 8> numbers;
    for (double& number : numbers) number = std::bit_cast<double>(random());
    if (std::ranges::any_of(numbers, [](double number) { return std::isnan(number); })) continue;
    rays.push_back(std::bit_cast<Ray>(numbers));
  }
  const std::vector<RayHit> hits(rays.size(), sample_hit());
  const std::string path = (folder / "rays.csv").string();
  std::ofstream(path) << written_ways(way_form(AnswerFormat::kCsv, true), rays, hits, true);
  const auto reader = open_rays(path, stdin);
  ASSERT_TRUE(reader) << reader.error().text;
  std::vector<Ray> again(rays.size() + 1);
  const auto count = (*reader)->read(again);
  ASSERT_TRUE(count) << count.error().text;
  ASSERT_EQ(*count, rays.size());
  EXPECT_EQ(std::memcmp(again.data(), rays.data(), rays.size() * sizeof(Ray)), 0);
}

}  // namespace
}  // namespace planetree::tools
