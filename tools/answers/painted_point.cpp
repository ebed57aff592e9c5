#include "tools/answers/painted_point.h"

namespace planetree::tools {

std::vector<PaintedPoint> painted(const Model& model, std::span<const ClosestPoint> answers) {
  std::vector<PaintedPoint> all;
  all.reserve(answers.size());
  for (const ClosestPoint& answer : answers) {
    PaintedPoint& point = all.emplace_back(PaintedPoint{answer, false, {}, {}, 0});
    if (answer.triangle == kNoTriangle) continue;
    const auto triangle = model.triangle(answer.triangle);
    if (!triangle) continue;
    point.has_attributes = true;
    point.color = triangle->color_at(answer.barycentric);
    point.uv = triangle->uv_at(answer.barycentric);
    point.value = triangle->value;
  }
  return all;
}

}  // namespace planetree::tools
