#pragma once

#include <span>
#include <vector>

#include "planetree/attributes.h"
#include "planetree/model.h"
#include "planetree/types.h"
#include "tools/answers/point_rows.h"

/// Answers with the attributes of their triangles.
namespace planetree::tools {

/// A nearest point, and what the file keeps of its triangle.
struct PaintedPoint : ClosestPoint {
  bool has_attributes = false;  ///< false: no triangle was found, or its pages cannot be read
  Color color;                  ///< at the point
  TextureCoordinate uv;         ///< at the point
  std::uint64_t value = 0;      ///< the bits
};

/// Reads the attributes of answers. The attribute layer must be open.
std::vector<PaintedPoint> painted(const Model& model, std::span<const ClosestPoint> answers);

template <class Fields>
void add_attributes(Fields& fields, const AnswerForm& form, const PaintedPoint& answer) {
  const auto state_of_kind = [&](std::uint32_t kind) {
    if ((form.attributes & kind) == 0) return FieldState::kNotRequested;
    return answer.has_attributes ? FieldState::kKnown : FieldState::kNone;
  };
  if (const FieldState state = state_of_kind(kKeepColor); state != FieldState::kNotRequested) {
    fields.count("red", answer.color.red, state);
    fields.count("green", answer.color.green, state);
    fields.count("blue", answer.color.blue, state);
    fields.count("alpha", answer.color.alpha, state);
  }
  if (const FieldState state = state_of_kind(kKeepUv); state != FieldState::kNotRequested) {
    fields.number("u", double{answer.uv.u}, state);
    fields.number("v", double{answer.uv.v}, state);
  }
  const FieldState state = state_of_kind(kKeepValue);
  if (state == FieldState::kNotRequested) return;
  if (form.value_kind == ValueKind::kUnsigned)
    fields.count("value", answer.value, state);
  else if (form.value_kind == ValueKind::kSigned)
    fields.integer("value", static_cast<std::int64_t>(answer.value), state);
  else
    fields.number("value", std::bit_cast<double>(answer.value), state);
}

template <class Fields>
void add_row(Fields& fields, const AnswerForm& form, const Vec3& query,
             const PaintedPoint& answer) {
  add_point(fields, form, query, answer);
  add_attributes(fields, form, answer);
  fields.end();
}

}  // namespace planetree::tools
