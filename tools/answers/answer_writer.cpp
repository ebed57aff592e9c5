#include "tools/answers/answer_writer.h"

#include <fmt/format.h>

#include <cassert>

#include "tools/answers/answer_fields.h"
#include "tools/answers/point_rows.h"
#include "tools/answers/way_rows.h"

namespace planetree::tools {
namespace {

// Text is printed in pieces of about this size.
constexpr std::size_t kPieceBytes = std::size_t{1} << 18;

template <class Fields, class Query, class Answer>
Result<bool> write_rows(AnswerOutput& output, const AnswerForm& form,
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

template <class Query, class Answer>
Result<bool> write_header(AnswerOutput& output, const AnswerForm& form) {
  if (form.format != AnswerFormat::kCsv) return true;
  fmt::memory_buffer text;
  HeaderFields fields(text);
  add_row(fields, form, Query(), Answer());
  return output.write({text.data(), text.size()});
}

template <class Query, class Answer>
Result<bool> write_in(AnswerOutput& output, const AnswerForm& form, std::span<const Query> queries,
                      std::span<const Answer> answers) {
  switch (form.format) {
    case AnswerFormat::kCsv:
      return write_rows<CsvFields>(output, form, queries, answers);
    case AnswerFormat::kJsonLines:
      return write_rows<JsonFields>(output, form, queries, answers);
    case AnswerFormat::kF64:
      break;
  }
  return write_rows<F64Fields>(output, form, queries, answers);
}

}  // namespace

Result<bool> AnswerWriter::begin(const ClosestPoint&) {
  return write_header<Vec3, ClosestPoint>(output_, form_);
}
Result<bool> AnswerWriter::begin(const Containment&) {
  return write_header<Vec3, Containment>(output_, form_);
}
Result<bool> AnswerWriter::begin(const RayHit&) {
  return write_header<Ray, RayHit>(output_, form_);
}
Result<bool> AnswerWriter::begin(const FirstContact&) {
  return write_header<Sweep, FirstContact>(output_, form_);
}

Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const ClosestPoint> answers) {
  return write_in(output_, form_, queries, answers);
}
Result<bool> AnswerWriter::write(std::span<const Vec3> queries,
                                 std::span<const Containment> answers) {
  return write_in(output_, form_, queries, answers);
}
Result<bool> AnswerWriter::write(std::span<const Ray> queries, std::span<const RayHit> answers) {
  return write_in(output_, form_, queries, answers);
}
Result<bool> AnswerWriter::write(std::span<const Sweep> queries,
                                 std::span<const FirstContact> answers) {
  return write_in(output_, form_, queries, answers);
}

}  // namespace planetree::tools
