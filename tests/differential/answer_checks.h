#pragma once

#include "planetree/types.h"
#include "tests/oracle/built_model.h"

/// Expectations of googletest that every answer must meet.
namespace planetree::oracle {

/// Queries, checks the answer and returns it. Every answer has the same bits when the query is
/// repeated, only finite numbers, the exact distance within [lower, upper], and no needlessly wide
/// interval. An exact answer names the triangle of least (value, index), found by evaluating every
/// triangle, and a point on it at that distance. An inexact answer is one that the limits allow. A
/// known side is the exact one.
ClosestPoint expect_sound(BuiltModel& model, const Vec3& query, const QueryOptions& options = {});

/// Queries for the side alone; it must be the exact one. If a model is not watertight and the
/// winding number is nearly one half, any side passes.
void expect_side(BuiltModel& model, const Vec3& query);

/// Every field has the same bits.
void expect_same_bits(const ClosestPoint& left, const ClosestPoint& right);

}  // namespace planetree::oracle
