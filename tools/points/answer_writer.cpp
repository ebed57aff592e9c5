#include "tools/points/answer_writer.h"

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

// Text is printed in pieces of about this size.
constexpr std::size_t kPieceBytes = std::size_t{1} << 18;

struct Named {
  std::string_view name;
  double number;
};

// The numbers of a row before and after the side.
std::array<Named, 6> numbers_before(const Vec3& query, const ClosestPoint& answer) {
  return {{{"x", query.x},
           {"y", query.y},
           {"z", query.z},
           {"distance", answer.distance},
           {"lower", answer.lower},
           {"upper", answer.upper}}};
}
std::array<Named, 3> numbers_before(const Vec3& query, const Containment&) {
  return {{{"x", query.x}, {"y", query.y}, {"z", query.z}}};
}
std::array<Named, 6> numbers_behind(const ClosestPoint& answer) {
  return {{{"px", answer.point.x},
           {"py", answer.point.y},
           {"pz", answer.point.z},
           {"nx", answer.normal.x},
           {"ny", answer.normal.y},
           {"nz", answer.normal.z}}};
}

class CsvRow {
 public:
  explicit CsvRow(fmt::memory_buffer& text) : out_(std::back_inserter(text)) {}

  void add(const Vec3& query, const ClosestPoint& answer) {
    add_numbers(numbers_before(query, answer));
    fmt::format_to(out_, "{},", side_word(answer.side));
    add_numbers(numbers_behind(answer));
    if (answer.triangle != kNoTriangle) fmt::format_to(out_, "{}", answer.triangle);
    fmt::format_to(out_, ",{},{}\n", feature_word(answer.feature), status_word(answer.status));
  }
  void add(const Vec3& query, const Containment& answer) {
    add_numbers(numbers_before(query, answer));
    fmt::format_to(out_, "{},{}\n", side_word(answer.side), status_word(answer.status));
  }

 private:
  template <std::size_t kCount>
  void add_numbers(const std::array<Named, kCount>& numbers) {
    for (const Named& named : numbers) fmt::format_to(out_, "{:.17g},", named.number);
  }

  std::back_insert_iterator<fmt::memory_buffer> out_;
};

class JsonRow {
 public:
  explicit JsonRow(fmt::memory_buffer& text) : out_(std::back_inserter(text)) {}

  void add(const Vec3& query, const ClosestPoint& answer) {
    add_numbers('{', numbers_before(query, answer));
    fmt::format_to(out_, ",\"side\":\"{}\"", side_word(answer.side));
    add_numbers(',', numbers_behind(answer));
    if (answer.triangle != kNoTriangle)
      fmt::format_to(out_, ",\"triangle\":{}", answer.triangle);
    else
      fmt::format_to(out_, ",\"triangle\":null");
    fmt::format_to(out_, ",\"feature\":\"{}\",\"status\":\"{}\"}}\n", feature_word(answer.feature),
                   status_word(answer.status));
  }
  void add(const Vec3& query, const Containment& answer) {
    add_numbers('{', numbers_before(query, answer));
    fmt::format_to(out_, ",\"side\":\"{}\",\"status\":\"{}\"}}\n", side_word(answer.side),
                   status_word(answer.status));
  }

 private:
  template <std::size_t kCount>
  void add_numbers(char before, const std::array<Named, kCount>& numbers) {
    for (const Named& named : numbers) {
      fmt::format_to(out_, "{}\"{}\":", before, named.name);
      // JSON has no infinity.
      if (std::isfinite(named.number))
        fmt::format_to(out_, "{:.17g}", named.number);
      else
        fmt::format_to(out_, "null");
      before = ',';
    }
  }

  std::back_insert_iterator<fmt::memory_buffer> out_;
};

class F64Row {
 public:
  explicit F64Row(fmt::memory_buffer& text) : text_(text) {}

  void add(const Vec3& query, const ClosestPoint& answer) {
    for (const Named& named : numbers_before(query, answer)) add(named.number);
    add(number_of(answer.side));
    for (const Named& named : numbers_behind(answer)) add(named.number);
    add(answer.triangle != kNoTriangle ? static_cast<double>(answer.triangle) : kNone);
  }
  void add(const Vec3& query, const Containment& answer) {
    for (const Named& named : numbers_before(query, answer)) add(named.number);
    add(number_of(answer.side));
  }

 private:
  static constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

  static double number_of(Side side) {
    return side == Side::kInside    ? -1
           : side == Side::kOutside ? 1
           : side == Side::kUnknown ? kNone
                                    : 0;
  }
  void add(double value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
    text_.append(bytes.data(), bytes.data() + bytes.size());
  }

  fmt::memory_buffer& text_;
};

template <class Row, class Answer>
bool write_rows(Console& console, std::span<const Vec3> queries, std::span<const Answer> answers) {
  assert(queries.size() == answers.size());
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    Row(text).add(queries[i], answers[i]);
    if (text.size() < kPieceBytes && i + 1 < queries.size()) continue;
    if (!console.print({text.data(), text.size()})) return false;
    text.clear();
  }
  return true;
}

template <class Answer>
bool write_as(AnswerFormat format, Console& console, std::span<const Vec3> queries,
              std::span<const Answer> answers) {
  switch (format) {
    case AnswerFormat::kCsv:
      return write_rows<CsvRow>(console, queries, answers);
    case AnswerFormat::kJsonLines:
      return write_rows<JsonRow>(console, queries, answers);
    case AnswerFormat::kF64:
      break;
  }
  return write_rows<F64Row>(console, queries, answers);
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

std::string_view side_word(Side side) {
  switch (side) {
    case Side::kInside:
      return "inside";
    case Side::kOutside:
      return "outside";
    case Side::kOnSurface:
      return "on_surface";
    case Side::kUnknown:
      break;
  }
  return "unknown";
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

bool AnswerWriter::heading(std::string_view names) {
  return format_ != AnswerFormat::kCsv || console_.print(names);
}

bool AnswerWriter::write(std::span<const Vec3> queries, std::span<const ClosestPoint> answers) {
  return write_as(format_, console_, queries, answers);
}

bool AnswerWriter::write(std::span<const Vec3> queries, std::span<const Containment> answers) {
  return write_as(format_, console_, queries, answers);
}

}  // namespace planetree::tools
