#include "tools/answers/answer_writer.h"

#include <fmt/format.h>

#include <cassert>

#include "tools/answers/answer_fields.h"
#include "tools/answers/answer_vertices.h"
#include "tools/answers/point_rows.h"
#include "tools/answers/way_rows.h"

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
    if (const auto added = add_vertex(cloud, form, answer); !added) return added.error();
  return true;
}

}  // namespace

template <class Query, class Answer>
Result<bool> AnswerWriter::begin_rows() {
  if (form_.format == AnswerFormat::kPly) {
    auto cloud = make_cloud(form_, Answer());
    if (!cloud) return cloud.error();
    cloud_.emplace(*std::move(cloud));
  }
  if (form_.format != AnswerFormat::kCsv) return true;
  fmt::memory_buffer text;
  HeaderFields fields(text);
  add_row(fields, form_, Query(), Answer());
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
    case AnswerFormat::kPly:
      break;
  }
  return add_vertices(*cloud_, form_, answers);
}

Result<bool> AnswerWriter::finish() { return cloud_ ? cloud_->write_to(output_) : true; }

Result<bool> AnswerWriter::begin(const ClosestPoint&) { return begin_rows<Vec3, ClosestPoint>(); }
Result<bool> AnswerWriter::begin(const Containment&) { return begin_rows<Vec3, Containment>(); }
Result<bool> AnswerWriter::begin(const RayHit&) { return begin_rows<Ray, RayHit>(); }
Result<bool> AnswerWriter::begin(const FirstContact&) { return begin_rows<Sweep, FirstContact>(); }

Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const ClosestPoint> answers) {
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
