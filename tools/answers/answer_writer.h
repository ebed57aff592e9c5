#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planetree/attributes.h"
#include "planetree/contact.h"
#include "planetree/types.h"
#include "tools/answers/answer_output.h"
#include "tools/answers/point_cloud.h"
#include "tools/arrays/column.h"
#include "tools/arrays/vtp_cloud.h"

namespace planetree::tools {

/// One row per answer: CSV, one JSON object per line, raw little-endian float64 values, or a NumPy
/// array. kPly, kVtp: the points of answers, as the vertices of a binary PLY or a VTK file.
enum class AnswerFormat : std::uint8_t { kCsv, kJsonLines, kF64, kNpy, kPly, kVtp };

/// How answers are written.
struct AnswerForm {
  AnswerFormat format = AnswerFormat::kCsv;
  /// Negative inside, NaN where the side is unknown; the column has another name.
  bool signed_distance = false;
  /// QueryOptions::parts. What was not requested is left out: an empty column, no key, no field, or
  /// NaN.
  std::uint32_t parts = kAllParts;
  /// Rays have t_min and t_max. In kF64 they always do.
  bool shows_range = false;
  std::uint32_t attributes = 0;                 ///< of PaintedPoint: those that the file keeps
  ValueKind value_kind = ValueKind::kUnsigned;  ///< of PaintedPoint
};

struct PaintedPoint;
struct PlacedPoint;

/// Writes answers in one form, one row per answer.
class AnswerWriter {
 public:
  /// output  must outlive this; for kNpy it must be one that can be rewritten
  AnswerWriter(AnswerOutput& output, const AnswerForm& form) : output_(output), form_(form) {
    form_.shows_range |= form.format == AnswerFormat::kF64;
  }

  /// Writes the header of answers of this type. False and errors as AnswerOutput::write().
  Result<bool> begin(const ClosestPoint&);
  Result<bool> begin(const PaintedPoint&);
  Result<bool> begin(const PlacedPoint&);
  Result<bool> begin(const Containment&);
  Result<bool> begin(const RayHit&);
  Result<bool> begin(const FirstContact&);
  /// Writes a row for each answer; the spans have equal lengths. False and errors as in begin().
  Result<bool> write(std::span<const Vec3> queries, std::span<const ClosestPoint> answers);
  Result<bool> write(std::span<const Vec3> queries, std::span<const PaintedPoint> answers);
  Result<bool> write(std::span<const Vec3> queries, std::span<const PlacedPoint> answers);
  Result<bool> write(std::span<const Vec3> queries, std::span<const Containment> answers);
  Result<bool> write(std::span<const Ray> queries, std::span<const RayHit> answers);
  Result<bool> write(std::span<const Sweep> queries, std::span<const FirstContact> answers);
  /// Writes what needs all answers. The last call. False and errors as in begin().
  Result<bool> finish();

 private:
  template <class Query, class Answer>
  Result<bool> begin_rows();
  template <class Query, class Answer>
  Result<bool> write_rows(std::span<const Query> queries, std::span<const Answer> answers);

  AnswerOutput& output_;
  AnswerForm form_;
  std::optional<PointCloud> cloud_;  // for kPly
  std::vector<Column> columns_;      // for kNpy
  std::uint64_t rows_ = 0;           // for kNpy
  std::optional<VtpCloud> vtp_;      // for kVtp
};

}  // namespace planetree::tools
