#include "tools/answers/answer_writer.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <vector>

#include "tests/tools/cli/captured_console.h"
#include "tools/answers/answer_words.h"

namespace planetree::tools {
namespace {

ClosestPoint sample_answer() {
  ClosestPoint answer;
  answer.distance = 0.1;
  answer.lower = 0.09;
  answer.upper = 1.0 / 3;
  answer.side = Side::kInside;
  answer.point = {-0.0, 1e-5, 2};
  answer.normal = {0, -1, 0};
  answer.triangle = 12345678901234;
  answer.feature = Feature::kEdge;
  answer.status = Status::kExact;
  return answer;
}

constexpr AnswerForm kCsv, kJsonLines{AnswerFormat::kJsonLines, false, kAllParts},
    kF64{AnswerFormat::kF64, false, kAllParts};

std::vector<double> numbers_of(const std::string& bytes) {
  std::vector<double> numbers(bytes.size() / sizeof(double));
  std::memcpy(numbers.data(), bytes.data(), numbers.size() * sizeof(double));
  return numbers;
}

template <class Answer>
std::string written(const AnswerForm& form, const Answer& answer) {
  CapturedConsole captured;
  auto output = AnswerOutput::open("-", false, captured.console());
  AnswerWriter writer(*output, form);
  const Vec3 query{1, std::numeric_limits<double>::quiet_NaN(), 0.1};
  EXPECT_TRUE(writer.write(std::span(&query, 1), std::span(&answer, 1)));
  return captured.output();
}

TEST(AnswerWriter, WritesTheShortestTextThatReadsBackTheSame) {
  EXPECT_EQ(written(kCsv, sample_answer()),
            "1,nan,0.1,0.1,0.09,0.3333333333333333,inside,-0,1e-05,2,0,-1,0,12345678901234,edge,"
            "exact\n");
  std::uint64_t bits = 1;
  for (int i = 0; i < 1000; ++i) {
    bits = bits * 6364136223846793005 + 1442695040888963407;
    ClosestPoint answer;
    answer.distance = std::bit_cast<double>(bits);
    if (!std::isfinite(answer.distance)) continue;
    const auto json = nlohmann::json::parse(written(kJsonLines, answer));
    EXPECT_EQ(json["distance"].get<double>(), answer.distance);
    const std::string row = written(kCsv, answer);
    EXPECT_EQ(std::strtod(row.c_str() + std::strlen("1,nan,0.1,"), nullptr), answer.distance);
  }
}

TEST(AnswerWriter, SignsTheDistanceByTheSide) {
  AnswerForm form;
  form.signed_distance = true;
  ClosestPoint answer = sample_answer();
  EXPECT_TRUE(written(form, answer).starts_with("1,nan,0.1,-0.1,0.09,"));
  answer.side = Side::kOutside;
  EXPECT_TRUE(written(form, answer).starts_with("1,nan,0.1,0.1,0.09,"));
  answer.side = Side::kUnknown;
  EXPECT_TRUE(written(form, answer).starts_with("1,nan,0.1,nan,0.09,"));
  answer.side = Side::kInside;
  answer.distance = 0;
  EXPECT_TRUE(written(form, answer).starts_with("1,nan,0.1,0,"));
  answer.distance = 0.25;
  form.format = AnswerFormat::kJsonLines;
  const auto json = nlohmann::json::parse(written(form, answer));
  EXPECT_EQ(json["signed_distance"], -0.25);
  EXPECT_FALSE(json.contains("distance"));
  form.format = AnswerFormat::kF64;
  EXPECT_EQ(numbers_of(written(form, answer))[3], -0.25);
}

TEST(AnswerWriter, LeavesOutPartsThatWereNotRequested) {
  AnswerForm form;
  form.parts = kDistance;
  EXPECT_EQ(written(form, sample_answer()),
            "1,nan,0.1,0.1,0.09,0.3333333333333333,,-0,1e-05,2,,,,12345678901234,edge,exact\n");
  form.parts = kSide;
  EXPECT_EQ(written(form, sample_answer()), "1,nan,0.1,,,,inside,,,,,,,,,exact\n");
  form.parts = kNormal;
  EXPECT_EQ(written(form, sample_answer()), written(kCsv, sample_answer()));
  form = {AnswerFormat::kJsonLines, false, kSide};
  const auto side = nlohmann::json::parse(written(form, sample_answer()));
  EXPECT_EQ(side["side"], "inside");
  for (const char* key : {"distance", "lower", "px", "nx", "triangle", "feature"})
    EXPECT_FALSE(side.contains(key)) << key;
  form.parts = kDistance;
  const auto distance = nlohmann::json::parse(written(form, sample_answer()));
  EXPECT_EQ(distance["feature"], "edge");
  for (const char* key : {"side", "nx"}) EXPECT_FALSE(distance.contains(key)) << key;
  form.format = AnswerFormat::kF64;
  const auto numbers = numbers_of(written(form, sample_answer()));
  EXPECT_EQ(numbers[3], 0.1);
  for (const std::size_t missing : {6u, 10u, 12u}) EXPECT_TRUE(std::isnan(numbers[missing]));
  EXPECT_EQ(numbers[13], 12345678901234.0);
}

TEST(AnswerWriter, LeavesAMissingTriangleEmpty) {
  ClosestPoint answer;
  answer.distance = answer.upper = std::numeric_limits<double>::infinity();
  answer.status = Status::kBeyondMaxDistance;
  EXPECT_EQ(written(kCsv, answer),
            "1,nan,0.1,inf,0,inf,unknown,0,0,0,0,0,1,,face,beyond_max_distance\n");
  const auto json = nlohmann::json::parse(written(kJsonLines, answer));
  EXPECT_EQ(json["triangle"], nullptr);
  EXPECT_EQ(json["distance"], nullptr);
  EXPECT_EQ(json["y"], nullptr);
}

TEST(AnswerWriter, WritesTheSideAlone) {
  const Containment answer{Side::kOnSurface, Status::kExact};
  EXPECT_EQ(written(kCsv, answer), "1,nan,0.1,on_surface,exact\n");
  const auto json = nlohmann::json::parse(written(kJsonLines, answer));
  EXPECT_EQ(json["side"], "on_surface");
  EXPECT_EQ(json["z"], 0.1);
  const std::string bytes = written(kF64, Containment{Side::kOutside, {}});
  double numbers[4];
  ASSERT_EQ(bytes.size(), sizeof numbers);
  std::memcpy(numbers, bytes.data(), sizeof numbers);
  EXPECT_EQ(numbers[3], 1.0);
}

TEST(AnswerWriter, WritesRawNumbers) {
  const std::string bytes = written(kF64, sample_answer());
  ASSERT_EQ(bytes.size(), 112u);
  double numbers[14];
  std::memcpy(numbers, bytes.data(), sizeof numbers);
  EXPECT_EQ(numbers[3], 0.1);
  EXPECT_EQ(numbers[6], -1.0);
  EXPECT_EQ(numbers[13], 12345678901234.0);
}

TEST(AnswerWriter, HasAWordForEveryEnumerator) {
  std::set<std::string_view> words;
  for (std::size_t i = 0; i < kStatusCount; ++i) words.insert(status_word(static_cast<Status>(i)));
  EXPECT_EQ(words, (std::set<std::string_view>{"exact", "within_error", "degraded",
                                               "beyond_max_distance", "bad_query"}));
  EXPECT_EQ(feature_word(Feature::kFace), "face");
  words.clear();
  for (std::size_t i = 0; i < kSideCount; ++i) words.insert(side_word(static_cast<Side>(i)));
  EXPECT_EQ(words, (std::set<std::string_view>{"inside", "outside", "on_surface", "unknown"}));
  EXPECT_EQ(feature_word(Feature::kVertex), "vertex");
}

}  // namespace
}  // namespace planetree::tools
