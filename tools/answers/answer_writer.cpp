#include "tools/answers/answer_writer.h"

#include <fmt/format.h>

#include <cassert>

#include "tools/answers/answer_fields.h"
#include "tools/answers/answer_vertices.h"
#include "tools/answers/array_fields.h"
#include "tools/answers/painted_point.h"
#include "tools/answers/placed_point.h"
#include "tools/answers/point_rows.h"
#include "tools/answers/way_rows.h"
#include "tools/arrays/npy_array.h"

namespace planetree::tools {
namespace {

// Text is printed in pieces of about this size.
constexpr std::size_t kPieceBytes = std::size_t{1} << 18;

template <class Fields, class Query, class Answer>
Result<bool> write_fields(AnswerOutput& output, const AnswerForm& form,
                          std::span<const Query> queries, std::span<const Answer> answers) {
  assert(queries.size() == answers.size());
  fmt::memory_buffer text;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    Fields fields(text);
    add_row(fields, form, queries[i], answers[i]);
    if (text.size() < kPieceBytes && i + 1 < queries.size()) continue;
    const auto written = output.write({text.data(), text.size()});
    if (!written || !*written) return written;
    text.clear();
  }
  return true;
}

template <class Answer>
Result<bool> add_vertices(PointCloud& cloud, const AnswerForm& form,
                          std::span<const Answer> answers) {
  for (const Answer& answer : answers)
    if (has_vertex(answer))
      if (const auto added = add_vertex(cloud, form, answer); !added) return added.error();
  return true;
}

template <class Query, class Answer>
Result<bool> add_rows(VtpCloud& cloud, const AnswerForm& form, std::span<const Query> queries,
                      std::span<const Answer> answers) {
  fmt::memory_buffer bytes;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    PackedFields fields(bytes);
    if (has_vertex(answers[i])) add_row(fields, form, queries[i], answers[i]);
    if (bytes.size() < kPieceBytes && i + 1 < queries.size()) continue;
    const auto added = cloud.add(std::as_bytes(std::span(bytes.data(), bytes.size())));
    if (!added) return added.error();
    bytes.clear();
  }
  return true;
}

template <class Query, class Answer>
std::vector<Column> columns_of(const AnswerForm& form) {
  std::vector<Column> columns;
  ColumnFields fields(columns);
  add_row(fields, form, Query(), Answer());
  return columns;
}

}  // namespace

template <class Query, class Answer>
Result<bool> AnswerWriter::begin_rows() {
  const Answer answer;
  if (form_.format == AnswerFormat::kPly) {
    auto cloud = PointCloud::create(shown_name(form_, answer), has_normals(form_, answer));
    if (!cloud) return cloud.error();
    cloud_.emplace(*std::move(cloud));
  }
  if (form_.format == AnswerFormat::kVtp)
    vtp_.emplace(columns_of<Query, Answer>(form_), std::string(vertex_name(answer)),
                 shown_name(form_, answer), output_.temporary_folder());
  if (form_.format == AnswerFormat::kNpy) {
    columns_ = columns_of<Query, Answer>(form_);
    return output_.write(npy_header_text(columns_, 0));
  }
  if (form_.format != AnswerFormat::kCsv) return true;
  fmt::memory_buffer text;
  HeaderFields fields(text);
  add_row(fields, form_, Query(), answer);
  return output_.write({text.data(), text.size()});
}

template <class Query, class Answer>
Result<bool> AnswerWriter::write_rows(std::span<const Query> queries,
                                      std::span<const Answer> answers) {
  switch (form_.format) {
    case AnswerFormat::kCsv:
      return write_fields<CsvFields>(output_, form_, queries, answers);
    case AnswerFormat::kJsonLines:
      return write_fields<JsonFields>(output_, form_, queries, answers);
    case AnswerFormat::kF64:
      return write_fields<F64Fields>(output_, form_, queries, answers);
    case AnswerFormat::kNpy:
      rows_ += queries.size();
      return write_fields<PackedFields>(output_, form_, queries, answers);
    case AnswerFormat::kPly:
      return add_vertices(*cloud_, form_, answers);
    case AnswerFormat::kVtp:
      break;
  }
  return add_rows(*vtp_, form_, queries, answers);
}

Result<bool> AnswerWriter::finish() {
  if (cloud_) return cloud_->write_to(output_);
  if (vtp_) return vtp_->write_to([this](std::string_view text) { return output_.write(text); });
  if (form_.format != AnswerFormat::kNpy) return true;
  const auto written = output_.rewrite_front(npy_header_text(columns_, rows_));
  return written ? Result<bool>(true) : written.error();
}

Result<bool> AnswerWriter::begin(const ClosestPoint&) { return begin_rows<Vec3, ClosestPoint>(); }
Result<bool> AnswerWriter::begin(const PaintedPoint&) { return begin_rows<Vec3, PaintedPoint>(); }
Result<bool> AnswerWriter::begin(const PlacedPoint&) { return begin_rows<Vec3, PlacedPoint>(); }
Result<bool> AnswerWriter::begin(const Containment&) { return begin_rows<Vec3, Containment>(); }
Result<bool> AnswerWriter::begin(const RayHit&) { return begin_rows<Ray, RayHit>(); }
Result<bool> AnswerWriter::begin(const FirstContact&) { return begin_rows<Sweep, FirstContact>(); }

Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const ClosestPoint> answers) {
  return write_rows(queries, answers);
}
Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const PaintedPoint> answers) {
  return write_rows(queries, answers);
}
Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const PlacedPoint> answers) {
  return write_rows(queries, answers);
}
Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const Containment> answers) {
  return write_rows(queries, answers);
}
Result<bool> AnswerWriter::write(std::span<const Ray> queries, std::span<const RayHit> answers) {
  return write_rows(queries, answers);
}
Result<bool> AnswerWriter::write(std::span<const Sweep> queries,
                                 std::span<const FirstContact> answers) {
  return write_rows(queries, answers);
}

}  // namespace planetree::tools
