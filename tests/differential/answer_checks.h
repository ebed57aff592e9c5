#pragma once

#include "planetree/types.h"
#include "tests/oracle/built_model.h"

/// What must hold of every answer, as expectations of googletest.
namespace planetree::oracle {

/// Queries, checks and returns the answer. Expected of every one: the same bits
/// when asked again, no number that is not finite, the exact distance within
/// [lower, upper], an interval that is honest but not lazy. Of an exact one:
/// the triangle of least (value, index) among all, found by evaluating each,
/// and a point that lies on it at that distance. Of an inexact one: that the
/// limits asked for allow it. A side that is told must be the exact one.
ClosestPoint expect_sound(BuiltModel& model, const Vec3& query, const QueryOptions& options = {});

/// Queries for the side alone; it must be the exact one. Where a model is not
/// watertight and the winding number is one half, nearly, it may be any.
void expect_side(BuiltModel& model, const Vec3& query);

/// Every field has the same bits.
void expect_same_bits(const ClosestPoint& left, const ClosestPoint& right);

}  // namespace planetree::oracle
