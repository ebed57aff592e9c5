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
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Named {
  std::string_view name;
  double number;
};

/// A query that needs the normal computes all other parts, too.
bool shows(const AnswerForm& form, std::uint32_t part) {
  return (form.parts & (part | kNormal)) != 0;
}

double signed_distance(const ClosestPoint& answer) {
  // Without the sign of a zero.
  if (answer.distance == 0 || answer.side == Side::kOnSurface) return answer.distance;
  if (answer.side == Side::kUnknown) return kNone;
  return answer.side == Side::kInside ? -answer.distance : answer.distance;
}

// The numbers of a row, in groups that belong to one part.
std::array<Named, 3> position(const Vec3& query) {
  return {{{"x", query.x}, {"y", query.y}, {"z", query.z}}};
}
std::array<Named, 3> interval(const ClosestPoint& answer, const AnswerForm& form) {
  if (form.signed_distance)
    return {{{"signed_distance", signed_distance(answer)},
             {"lower", answer.lower},
             {"upper", answer.upper}}};
  return {{{"distance", answer.distance}, {"lower", answer.lower}, {"upper", answer.upper}}};
}
std::array<Named, 3> nearest_point(const ClosestPoint& answer) {
  return {{{"px", answer.point.x}, {"py", answer.point.y}, {"pz", answer.point.z}}};
}
std::array<Named, 3> normal(const ClosestPoint& answer) {
  return {{{"nx", answer.normal.x}, {"ny", answer.normal.y}, {"nz", answer.normal.z}}};
}

class CsvRow {
 public:
  CsvRow(fmt::memory_buffer& text, const AnswerForm& form)
      : out_(std::back_inserter(text)), form_(form) {}

  void add(const Vec3& query, const ClosestPoint& answer) {
    const bool has_distance = shows(form_, kDistance), has_side = shows(form_, kSide);
    add_numbers(position(query), true);
    add_numbers(interval(answer, form_), has_distance);
    fmt::format_to(out_, "{},", has_side ? side_word(answer.side) : "");
    add_numbers(nearest_point(answer), has_distance);
    add_numbers(normal(answer), shows(form_, kNormal));
    if (has_distance && answer.triangle != kNoTriangle) fmt::format_to(out_, "{}", answer.triangle);
    fmt::format_to(out_, ",{},{}\n", has_distance ? feature_word(answer.feature) : "",
                   status_word(answer.status));
  }
  void add(const Vec3& query, const Containment& answer) {
    add_numbers(position(query), true);
    fmt::format_to(out_, "{},{}\n", side_word(answer.side), status_word(answer.status));
  }

 private:
  void add_numbers(const std::array<Named, 3>& numbers, bool shown) {
    for (const Named& named : numbers) {
      if (shown)
        fmt::format_to(out_, "{},", named.number);
      else
        fmt::format_to(out_, ",");
    }
  }

  std::back_insert_iterator<fmt::memory_buffer> out_;
  const AnswerForm& form_;
};

class JsonRow {
 public:
  JsonRow(fmt::memory_buffer& text, const AnswerForm& form)
      : out_(std::back_inserter(text)), form_(form) {}

  void add(const Vec3& query, const ClosestPoint& answer) {
    const bool has_distance = shows(form_, kDistance);
    add_numbers('{', position(query));
    if (has_distance) add_numbers(',', interval(answer, form_));
    if (shows(form_, kSide)) fmt::format_to(out_, ",\"side\":\"{}\"", side_word(answer.side));
    if (has_distance) add_numbers(',', nearest_point(answer));
    if (shows(form_, kNormal)) add_numbers(',', normal(answer));
    if (has_distance) add_triangle(answer);
    fmt::format_to(out_, ",\"status\":\"{}\"}}\n", status_word(answer.status));
  }
  void add(const Vec3& query, const Containment& answer) {
    add_numbers('{', position(query));
    fmt::format_to(out_, ",\"side\":\"{}\",\"status\":\"{}\"}}\n", side_word(answer.side),
                   status_word(answer.status));
  }

 private:
  void add_triangle(const ClosestPoint& answer) {
    if (answer.triangle != kNoTriangle)
      fmt::format_to(out_, ",\"triangle\":{}", answer.triangle);
    else
      fmt::format_to(out_, ",\"triangle\":null");
    fmt::format_to(out_, ",\"feature\":\"{}\"", feature_word(answer.feature));
  }
  void add_numbers(char before, const std::array<Named, 3>& numbers) {
    for (const Named& named : numbers) {
      fmt::format_to(out_, "{}\"{}\":", before, named.name);
      // JSON has no infinity.
      if (std::isfinite(named.number))
        fmt::format_to(out_, "{}", named.number);
      else
        fmt::format_to(out_, "null");
      before = ',';
    }
  }

  std::back_insert_iterator<fmt::memory_buffer> out_;
  const AnswerForm& form_;
};

class F64Row {
 public:
  F64Row(fmt::memory_buffer& text, const AnswerForm& form) : text_(text), form_(form) {}

  void add(const Vec3& query, const ClosestPoint& answer) {
    const bool has_distance = shows(form_, kDistance);
    add_numbers(position(query), true);
    add_numbers(interval(answer, form_), has_distance);
    add(shows(form_, kSide) ? number_of(answer.side) : kNone);
    add_numbers(nearest_point(answer), has_distance);
    add_numbers(normal(answer), shows(form_, kNormal));
    const bool has_triangle = has_distance && answer.triangle != kNoTriangle;
    add(has_triangle ? static_cast<double>(answer.triangle) : kNone);
  }
  void add(const Vec3& query, const Containment& answer) {
    add_numbers(position(query), true);
    add(number_of(answer.side));
  }

 private:
  static double number_of(Side side) {
    return side == Side::kInside    ? -1
           : side == Side::kOutside ? 1
           : side == Side::kUnknown ? kNone
                                    : 0;
  }
  void add_numbers(const std::array<Named, 3>& numbers, bool shown) {
    for (const Named& named : numbers) add(shown ? named.number : kNone);
  }
  void add(double value) {
    const auto bytes = std::bit_cast<std::array<char, sizeof value>>(value);
    text_.append(bytes.data(), bytes.data() + bytes.size());
  }

  fmt::memory_buffer& text_;
  const AnswerForm& form_;
};

template <class Row, class Answer>
Result<bool> write_rows(AnswerOutput& output, const AnswerForm& form, std::span<const Vec3> queries,
                        std::span<const Answer> answers) {
  assert(queries.size() == answers.size());
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    Row(text, form).add(queries[i], answers[i]);
    if (text.size() < kPieceBytes && i + 1 < queries.size()) continue;
    const auto written = output.write({text.data(), text.size()});
    if (!written || !*written) return written;
    text.clear();
  }
  return true;
}

template <class Answer>
Result<bool> write_in(const AnswerForm& form, AnswerOutput& output, std::span<const Vec3> queries,
                      std::span<const Answer> answers) {
  switch (form.format) {
    case AnswerFormat::kCsv:
      return write_rows<CsvRow>(output, form, queries, answers);
    case AnswerFormat::kJsonLines:
      return write_rows<JsonRow>(output, form, queries, answers);
    case AnswerFormat::kF64:
      break;
  }
  return write_rows<F64Row>(output, form, queries, answers);
}

}  // namespace

Result<bool> AnswerWriter::begin(const ClosestPoint&) {
  if (form_.format != AnswerFormat::kCsv) return true;
  const std::string_view distance = form_.signed_distance ? "signed_distance" : "distance";
  return output_.write(fmt::format(
      "x,y,z,{},lower,upper,side,px,py,pz,nx,ny,nz,triangle,feature,status\n", distance));
}

Result<bool> AnswerWriter::begin(const Containment&) {
  if (form_.format != AnswerFormat::kCsv) return true;
  return output_.write("x,y,z,side,status\n");
}

Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const ClosestPoint> answers) {
  return write_in(form_, output_, queries, answers);
}

Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const Containment> answers) {
  return write_in(form_, output_, queries, answers);
}

}  // namespace planetree::tools
