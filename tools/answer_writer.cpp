#include "tools/answer_writer.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>

namespace planetree::tools {
namespace {

static_assert(std::endian::native == std::endian::little, "f64 rows are written in place");

// Text is handed on in pieces of about this size.
constexpr std::size_t kPieceBytes = std::size_t{1} << 18;

constexpr std::array<std::string_view, 9> kNumberNames = {"x",     "y",  "z",  "distance", "lower",
                                                          "upper", "px", "py", "pz"};

std::array<double, 9> numbers_of(const Vec3& query, const ClosestPoint& answer) {
  return {query.x,      query.y,        query.z,        answer.distance, answer.lower,
          answer.upper, answer.point.x, answer.point.y, answer.point.z};
}

void add_csv(fmt::memory_buffer& text, const Vec3& query, const ClosestPoint& answer) {
  const auto out = std::back_inserter(text);
  for (const double number : numbers_of(query, answer)) fmt::format_to(out, "{:.17g},", number);
  if (answer.triangle != kNoTriangle) fmt::format_to(out, "{}", answer.triangle);
  fmt::format_to(out, ",{},{}\n", feature_word(answer.feature), status_word(answer.status));
}

void add_json(fmt::memory_buffer& text, const Vec3& query, const ClosestPoint& answer) {
  const auto out = std::back_inserter(text);
  const auto numbers = numbers_of(query, answer);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    fmt::format_to(out, "{}\"{}\":", i == 0 ? '{' : ',', kNumberNames[i]);
    // JSON has no word for infinity.
    if (std::isfinite(numbers[i]))
      fmt::format_to(out, "{:.17g}", numbers[i]);
    else
      fmt::format_to(out, "null");
  }
  if (answer.triangle != kNoTriangle)
    fmt::format_to(out, ",\"triangle\":{}", answer.triangle);
  else
    fmt::format_to(out, ",\"triangle\":null");
  fmt::format_to(out, ",\"feature\":\"{}\",\"status\":\"{}\"}}\n", feature_word(answer.feature),
                 status_word(answer.status));
}

void add_f64(fmt::memory_buffer& text, const Vec3& query, const ClosestPoint& answer) {
  const auto add = [&text](double value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
    text.append(bytes.data(), bytes.data() + bytes.size());
  };
  for (const double number : numbers_of(query, answer)) add(number);
  add(answer.triangle != kNoTriangle ? static_cast<double>(answer.triangle)
                                     : std::numeric_limits<double>::quiet_NaN());
}

}  // namespace

std::string_view feature_word(Feature feature) {
  switch (feature) {
    case Feature::kFace:
      return "face";
    case Feature::kEdge:
      return "edge";
    case Feature::kVertex:
      break;
  }
  return "vertex";
}

std::string_view status_word(Status status) {
  switch (status) {
    case Status::kExact:
      return "exact";
    case Status::kWithinError:
      return "within_error";
    case Status::kDegraded:
      return "degraded";
    case Status::kBeyondMaxDistance:
      return "beyond_max_distance";
    case Status::kBadQuery:
      break;
  }
  return "bad_query";
}

bool AnswerWriter::begin() {
  if (format_ != AnswerFormat::kCsv) return true;
  return console_.print("x,y,z,distance,lower,upper,px,py,pz,triangle,feature,status\n");
}

bool AnswerWriter::write(std::span<const Vec3> queries, std::span<const ClosestPoint> answers) {
  assert(queries.size() == answers.size());
  const auto add = format_ == AnswerFormat::kCsv         ? add_csv
                   : format_ == AnswerFormat::kJsonLines ? add_json
                                                         : add_f64;
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    add(text, queries[i], answers[i]);
    if (text.size() < kPieceBytes && i + 1 < queries.size()) continue;
    if (!console_.print({text.data(), text.size()})) return false;
    text.clear();
  }
  return true;
}

}  // namespace planetree::tools
