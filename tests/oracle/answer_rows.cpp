#include "tests/oracle/answer_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <istream>
#include <optional>
#include <sstream>
#include <string_view>
#include <utility>

namespace planetree::oracle {
namespace {

constexpr std::pair<std::string_view, Side> kSides[] = {{"inside", Side::kInside},
                                                        {"outside", Side::kOutside},
                                                        {"on_surface", Side::kOnSurface},
                                                        {"unknown", Side::kUnknown}};
constexpr std::pair<std::string_view, Status> kStatuses[] = {
    {"exact", Status::kExact},
    {"within_error", Status::kWithinError},
    {"degraded", Status::kDegraded},
    {"beyond_max_distance", Status::kBeyondMaxDistance},
    {"bad_query", Status::kBadQuery}};

enum Column : std::size_t { kX, kY, kZ, kLength, kLower, kUpper, kSideWord, kTriangle, kStatus };
constexpr std::array<std::string_view, 9> kColumns = {
    "x", "y", "z", "distance", "lower", "upper", "side", "triangle", "status"};
using Indices = std::array<std::size_t, kColumns.size()>;

Error bad(std::size_t line, const std::string& why) {
  return make_error(ErrorCode::kBadInput, Error::kNowhere, Error::kNowhere,
                    "line %zu: %s; give what planetree query writes as CSV", line, why.c_str());
}

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  return fields;
}

Result<Indices> columns_in(const std::string& header) {
  const std::vector<std::string> names = fields_of(header);
  Indices indices{};
  for (std::size_t i = 0; i < kColumns.size(); ++i) {
    const auto found = std::find(names.begin(), names.end(), kColumns[i]);
    if (found == names.end()) return bad(1, "no column " + std::string(kColumns[i]));
    indices[i] = static_cast<std::size_t>(found - names.begin());
  }
  return indices;
}

std::optional<double> number(const std::string& field) {
  char* end = nullptr;
  const double value = std::strtod(field.c_str(), &end);
  if (field.empty() || *end != '\0') return {};
  return value;
}

std::optional<std::uint64_t> index(const std::string& field) {
  if (field.empty()) return kNoTriangle;
  char* end = nullptr;
  const std::uint64_t value = std::strtoull(field.c_str(), &end, 10);
  if (*end != '\0') return {};
  return value;
}

template <class T, std::size_t kCount>
std::optional<T> meaning(const std::pair<std::string_view, T> (&words)[kCount],
                         const std::string& field) {
  for (const auto& [word, value] : words)
    if (word == field) return value;
  return {};
}

// False if the field has no value of its column's type.
template <class T>
bool put(const std::optional<T>& from, T& into) {
  if (from) into = *from;
  return from.has_value();
}

Result<AnswerRow> row_of(std::string text, const Indices& indices, std::size_t line) {
  const std::vector<std::string> fields = fields_of(text);
  if (fields.size() <= *std::max_element(indices.begin(), indices.end()))
    return bad(line, "too few columns");
  const auto field = [&](Column column) { return fields[indices[column]]; };
  AnswerRow row;
  const bool sound =
      put(number(field(kX)), row.query.x) && put(number(field(kY)), row.query.y) &&
      put(number(field(kZ)), row.query.z) && put(number(field(kLength)), row.distance) &&
      put(number(field(kLower)), row.lower) && put(number(field(kUpper)), row.upper) &&
      put(meaning(kSides, field(kSideWord)), row.side) &&
      put(index(field(kTriangle)), row.triangle) &&
      put(meaning(kStatuses, field(kStatus)), row.status);
  if (!sound) return bad(line, "no answer reads so");
  row.text = std::move(text);
  return row;
}

}  // namespace

bool is_finite(const Vec3& query) {
  return std::isfinite(query.x) && std::isfinite(query.y) && std::isfinite(query.z);
}

Result<std::vector<AnswerRow>> read_answers(std::istream& csv, std::size_t most) {
  std::string line;
  std::getline(csv, line);
  const Result<Indices> indices = columns_in(line);
  if (!indices) return indices.error();
  std::vector<AnswerRow> rows;
  while (rows.size() < most && std::getline(csv, line)) {
    Result<AnswerRow> row = row_of(std::move(line), *indices, rows.size() + 2);
    if (!row) return row.error();
    rows.push_back(std::move(*row));
  }
  return rows;
}

}  // namespace planetree::oracle
