#pragma once

/// Error bounds that answers rest on, each with what it covers. docs/numerics.md adds them up.
///
/// u = 2^-53 and v = 2^-24 are the largest relative errors of one rounding of double and of float.
/// Where a thread's rounding mode may be directed, a rounding errs by up to 2 u. Limits of
/// coordinates are in octree/geometry/tree_limits.h. A constant that only one algorithm uses may
/// stand beside that algorithm, with its derivation.
namespace planetree::octree {

inline constexpr double kDoubleRoundoff = 0x1p-53;  ///< u
inline constexpr float kFloatRoundoff = 0x1p-24f;   ///< v
/// Least normal number of float. A divisor or a bound of at least this has lost no bits.
inline constexpr float kMinFloatNormal = 0x1p-126f;

// Distances in double.

/// Relative error of the norm of a vector. Three differences, three squares, two sums and a root
/// err by less than 4 u of the length; times 8.
inline constexpr double kNormRounding = 0x1p-48;
/// Lengths below this are not resolved. A square loses at most 2^-1075 by underflow, so a root
/// moves by at most 2^-537.
inline constexpr double kUnresolvedLength = 0x1p-500;
/// Relative error of an end of an interval: one addition errs by u.
inline constexpr double kEndRounding = 0x1p-52;
/// Relative error of the distance between two queries, which is a norm: below 4 u.
inline constexpr double kGapRounding = 0x1p-40;
/// Relative error of the distance to the farthest corner of a box. Three differences, squares, sums
/// and a root err by less than 8 u.
inline constexpr double kFarthestInflation = 1 + 0x1p-40;

// Rigid transforms: octree/geometry/rigid_transform.h derives both.

/// Error of a rotated point, as a share of its length, where the quaternion has length 1. Rounding
/// errs by 44 u, the quaternion's length by 8.2 u, its rounding by 2 u; 9 u are spare.
inline constexpr double kRotationRounding = 64 * kDoubleRoundoff;
/// Error of a translated point, as a share of the length of the translation: its rounding errs by
/// u, that of the sum by 1.1 u; about doubled.
inline constexpr double kTranslationRounding = 4 * kDoubleRoundoff;

// The value of a triangle: octree/geometry/triangle_distance.h.

/// A face whose largest angle has a squared sine below this is evaluated with 113 bits. A face's
/// value loses 1 / sine, here 5 bits.
inline constexpr double kMinFaceSine2 = 0x1p-10;
/// A smaller squared normal has lost bits to underflow. A product loses at most 2^-1075, which is
/// 2^-145 of this.
inline constexpr double kMinFaceNormal2 = 0x1p-930;
/// Rounding error of a value, as a multiple of (distance of the farthest corner) / sine. The cross
/// product errs by 5 u, its three dot products by 3 u each, and the inside test by 2 (4 + 5) u
/// across an edge; the sum of 32 u is doubled.
inline constexpr double kValueErrorFactor = 64 * kDoubleRoundoff;
/// A face of a smaller squared sine counts as its edges. It lies within 2^-50 of an edge's length
/// of them. The farthest corner is at least half the longest edge away, so this costs less than
/// 2^-49 of its distance, a quarter of kValueErrorFactor.
inline constexpr double kDegenerateFaceSine2 = 0x1p-100;
/// Bound on the model's diagonal: in the model frame the longest edge of its box is below 2, so
/// that the diagonal is below 2 sqrt(3).
inline constexpr double kMaxDiagonal = 4;
/// Error of a value near a limit, as a share of the limit and TreeInfo::span(). kValueErrorFactor
/// over the least sine, 2^-5, is 2^-42 of the distance of the farthest corner, which is at most
/// their sum; times 4.
inline constexpr double kValueRounding = 0x1p-40;

/// Margin of the distances at which a point shell prunes, as a share of the limit and the diagonal
/// of the model's box: query/shell/shell_query.h. Values err by 2^-42 of their sum; times 4. So
/// what is pruned would have had no depth as computed either.
inline constexpr double kShellSlack = 0x1p-40;

// The coarse field: octree/field/coarse_field.h. Its lengths are in quanta; the grid is shorter
// than 2^17 of them, so that a position in it errs by 2^-7 in float.

/// Error of a squared distance in float, as a share of it, and of an interpolation between eight of
/// them, as a share of the greatest: differences, squares and sums err by 8 v, three interpolations
/// by 6 v.
inline constexpr double kFieldRounding = 16 * 0x1p-24;
/// Error of a stored point by rounding in double, as a share of the greatest coordinate M. A grid
/// point moves by sqrt(3) u M, which counts twice; the surface point by kNearestPointRounding along
/// each axis, 4 sqrt(3) u M. Together they are below 11 u M.
inline constexpr double kFieldPointRounding = 16 * kDoubleRoundoff;
/// Relative error of a distance in double, from outside of the grid to it or to a stored point:
/// scaling, differences, squares, sums and root err by less than 16 u.
inline constexpr double kFieldNormRounding = 0x1p-40;

// Signs of determinants and overlap of boxes, in double.

/// Error of a 3 x 3 determinant, as a share of its permanent: four times Shewchuk's (7 + 56 u) u,
/// so that it holds where each rounding errs by a whole ulp.
inline constexpr double kOrientationFilter = 32 * kDoubleRoundoff;
/// The same of a 2 x 2 determinant: four times Shewchuk's (3 + 16 u) u.
inline constexpr double kNormalSignFilter = 16 * kDoubleRoundoff;
/// Error of a sum of such determinants, for each of them, as a share of the sum of their
/// permanents.
inline constexpr double kAreaSumFilter = 4 * kDoubleRoundoff;
/// What flushing subnormal differences and products to zero may change, times (1 + largest
/// difference)^2. Each operation loses at most 2^-1022 times two such factors; 2^12 operations fit.
inline constexpr double kFlushLoss = 0x1p-1010;
/// Error of a sum of products by which a triangle and a box are told apart, as a share of the
/// products' magnitudes. At most 6 products of at most 3 rounded factors err by less than 16 u;
/// doubled.
inline constexpr double kOverlapMargin = 0x1p-48;
/// Absolute error of products that underflow. A product loses at most 2^-1075, times a third factor
/// below 2^113 in the model frame.
inline constexpr double kProductUnderflow = 0x1p-950;

// Where lines pass through triangles: octree/geometry/line_crossing.h.

/// Relative error of a quotient of two numbers that are right to 2^-53 each: the quotient rounds
/// once more, below 4 u; doubled for directed rounding.
inline constexpr double kRatioRounding = 8 * kDoubleRoundoff;
/// Least magnitude of a position that is not 0: a smaller one is rounded to it.
inline constexpr double kMinPosition = 0x1p-1022;
/// Relative error of the bound on a position's error: fewer than 16 roundings.
inline constexpr double kPositionInflation = 1 + 0x1p-48;
/// Greatest error of a position that is taken from double, as a share of the way to the triangle.
/// A choice and no proof: positions of greater error are computed with exact numbers.
inline constexpr double kMaxPositionError = 0x1p-40;

// Moving balls: octree/geometry/moving_ball.h.

/// Error of a centre on its way, as a share of the greatest coordinate M of both ends. The way errs
/// by 2 u M along each axis, its product by 2 u M and the sum by u M: sqrt(3) 5 u M; the sum is
/// taken three times.
inline constexpr double kPositionRounding = 32 * kDoubleRoundoff;
/// Error of the height of a centre over a corner, as a share of the greatest coordinate of the
/// vector from corner to centre. The difference, three products and two sums err by 5 u of 3 times
/// that; doubled. The same holds for the speed along a normal.
inline constexpr double kPlaneRounding = 32 * kDoubleRoundoff;
/// Least closing speed that a search for a certain contact begins with, as a share of the speed. A
/// choice and no proof.
inline constexpr double kMinClosingShare = 0x1p-20;

/// By how much a box grows before a line is clipped to it, as a share of the coordinates: far more
/// than positions and their quotients err.
inline constexpr double kClipMargin = 0x1p-40;

// Bounds in float of boxes and discs: octree/traversal/bounds.h. There D is the distance to the
// centre of a box, d the distance to the surface in it, and r the diagonal of the box.

/// Error of D^2 - h^2, as a share of D^2. Rounding errs by 24 v and a normal that is of length 1
/// within 4 v by 8 v; 8 v are spare.
inline constexpr float kDiscCancellation = 40 * kFloatRoundoff;
/// What the builder adds to stored offsets of discs, as a share of the box's diagonal. A height
/// errs by 8 v D, and D is at most d + r: the part 8 v r is paid here, twice.
inline constexpr double kDiscOffsetSlack = 16 * 0x1p-24;
/// Relative error of bounds. Bounds of boxes err by 4 v, those of discs by 16 v; doubled.
inline constexpr double kBoundInflation = 1 + 32 * 0x1p-24;
/// Absolute error of bounds. The value of a triangle may err by 2^-40, which is 2^-42 of
/// kMaxDiagonal. Offsets of boxes smaller than 2^-63 underflow, and doubles relative to the centre
/// are rounded to u of the model's side: below 2^-50. The sum is taken four times. So no triangle
/// is pruned that is equally near within the error of its value, in whatever order children are
/// visited.
inline constexpr double kAbsoluteBoundSlack = 0x1p-38;
/// Returns the absolute error of bounds in a model with strays that come near its core. The value
/// of such a stray may err by as much more as its edge is longer than kMaxDiagonal. Other strays
/// are no longer than their distance from the core, so that their values err by 2^-41 of it, which
/// kBoundInflation covers. Near a stray, a query is so far from
/// the centre that kFloatQueryRounding covers the error.
///
/// stray_edge  see storage::ModelRecord::stray_edge
constexpr double bound_slack(double stray_edge) {
  return stray_edge > kMaxDiagonal ? kAbsoluteBoundSlack * (stray_edge / kMaxDiagonal)
                                   : kAbsoluteBoundSlack;
}
/// Error of a query rounded to float, as a share of its greatest coordinate: each coordinate errs
/// by v of it, together sqrt(3) v.
inline constexpr double kFloatQueryRounding = 2 * 0x1p-24;
/// Relative error of rounding up to float: a conversion errs by v.
inline constexpr double kRoundUpInflation = 1 + 0x1p-22;
/// Error of a box rounded outward to float, as a share of its greatest coordinate: a conversion
/// errs by v, the difference before it by u.
inline constexpr double kBoxRounding = 2 * 0x1p-24;
/// Relative error of the extent of a block. Three differences, squares and sums err by 6 v of the
/// square, which is 3 v of the root; root and product err by v each. The sum is below 8 v.
inline constexpr float kExtentInflation = 1 + 0x1p-20f;
/// Error of a segment in float, as a share of the greatest coordinate M of the segment and of what
/// is tested against it. Slope and offset err by 2 v M each, the product by v M, and the sum, at
/// most 3 M, by 3 v M; doubled for the rounding of the range itself.
inline constexpr double kSegmentRounding = 0x1p-20;

// The float filter of triangles: octree/traversal/triangle_filter-inl.h. There A is the longest
// vector from the query to a corner or along a side. A product of two such vectors errs by 5 v of
// their lengths.

/// Error of the squared distance to an edge, as a share of A^2. With a2 the squared distance of its
/// start, the distance is a2 - t (2 along - t edge2). Any t in [0, 1] gives a point of the edge, so
/// that only this expression errs, by 40 v.
inline constexpr float kFilterEdgeError = 64 * kFloatRoundoff;
/// Error of the squared distance to a face, as a share of |a|^2 / sine^2 of the angle at a. The
/// numerators err by 23 v |a| |ab| |ac|^2 and the like, the divisor by 23 v |ab|^2 |ac|^2: 70 v.
inline constexpr float kFilterFaceError = 128 * kFloatRoundoff;
/// Faces of a smaller squared sine are bounded by their edges. At this sine a face errs by 2^-11 of
/// |a|^2.
inline constexpr float kFilterMinSine2 = 0x1p-6f;
/// Error of corners and query relative to a block, as a share of distance and extent. Vertex,
/// query and their difference err by sqrt(3) 3 v. It is taken twice where a filter value is
/// inverted: from d <= value + s (d + extent) follows value + s (value + extent) / (1 - s).
inline constexpr double kFilterPositionSlack = 0x1p-19;
/// Error of ab2 ac2 - (ab.ac)^2, as a share of ab2 ac2. Each product errs by 11 v and the
/// difference by v: 23 v.
inline constexpr float kFilterDeterminantError = 64 * kFloatRoundoff;
/// The same where products underflow. They lose at most 2^-149.
inline constexpr float kFilterDeterminantUnderflow = 0x1p-99f;
/// Faces with a smaller determinant are bounded by their edges, because its products may have
/// underflowed.
inline constexpr float kFilterMinDeterminant = 0x1p-100f;
/// Triangles whose longest side has a smaller square have the lower bound 0. Their height would be
/// divided by what underflow has changed.
inline constexpr float kFilterMinSide2 = 0x1p-90f;

// Normals and the coherence cache.

/// Faces of a smaller squared sine get their normal with 113 bits. A cross product errs by 5 u over
/// the sine, which is 2^-26.7 rad here.
inline constexpr double kThinFaceSine2 = 0x1p-48;
/// Shorter edges get their normal with 113 bits: products of four of them, 2^-800, must stay far
/// above 2^-1022.
inline constexpr double kMinNormalEdge = 0x1p-200;
/// A sum of normals shorter than this share of its weights counts as zero. A choice and no proof: a
/// unit normal errs by 5 u over its face's sine.
inline constexpr double kCancelledNormalShare = 0x1p-40;
/// Error of an angle times the height of a query over a face, as shares of the distance: of what
/// grows with the inverse of the sine at the corner, and of the rest. octree/nearest/front_side.cpp
/// derives 4 (64 u) and 4 (32 u) + 2^-49; both are doubled or more.
inline constexpr double kFrontSineError = 512 * kDoubleRoundoff;
inline constexpr double kFrontError = 4096 * kDoubleRoundoff;
/// The same with 113 bits, as powers of two; the angle is right to 2^-100.
inline constexpr int kWideFrontSineErrorBits = -104, kWideFrontErrorBits = -96;
/// A query nearer to its nearest point than this share of the coordinates is in no direction from
/// it. The point errs by kNearestPointRounding; 2^15 of that are left.
inline constexpr double kMinDirectionShare = 0x1p-36;
/// Error of a nearest point, as a share of its greatest coordinate: five roundings of shares and
/// sums. Coordinates may be far larger than the model.
inline constexpr double kNearestPointRounding = 0x1p-51;
/// Rises of the distance and gaps of the surface that rounding explains, between two triangles of
/// which one is no contact of its own: in errors of the triangle's distance, for its own value and
/// that of the way, and as a share of its greatest coordinate. A corner rounded onto an edge errs
/// by sqrt(3) u, a nearest point by kNearestPointRounding; the sum is doubled and rounded up.
inline constexpr double kContactErrors = 2;
inline constexpr double kContactRounding = 0x1p-49;
/// Error of all sums and bounds of the coherence cache, relative and absolute. It is 2^14 times
/// kAbsoluteBoundSlack and 2^29 times u.
inline constexpr double kCoherenceSlack = 0x1p-24;

// Solid angles and winding numbers. The vector whose angle is half of a solid angle is derived in
// octree/geometry/angles.cpp, shares of far subtrees in octree/winding/multipole.h.

/// Vectors with a greater share of error are computed with wider numbers. The share of a triangle
/// is then right within a quarter of this and kAngleError, below 2^-25.
inline constexpr double kMaxHalfAngleError = 0x1p-24;
/// Error of the end of the vector in double, in units of |a||b||c|. A vector to a corner has
/// components right to one rounding and a length right to four. Each of the four terms of the width
/// loses at most 12 u by its factors and its sum. The height loses 9 u: its six terms have
/// magnitudes that sum to at most 1.16. Together the end is off by at most 50 u, and by 100 u where
/// each rounding errs by a whole ulp.
inline constexpr double kHalfAngleError = 256 * kDoubleRoundoff;
/// The same in wider numbers, as a power of two of their last bit. A product of three components of
/// unit vectors is right to 24 roundings; the sums of width and height stay below 2^8.
inline constexpr int kWideHalfAngleErrorBits = 8;
/// Range of squared lengths for double. The product of three lengths is squared: 2^-960 has lost no
/// bits to underflow, and four terms of 2^960 do not overflow.
inline constexpr double kMinAngleLength2 = 0x1p-320, kMaxAngleLength2 = 0x1p320;
/// Error of a share by that of its vector: asin(x) is at most (pi / 2) x, divided by 2 pi.
inline constexpr double kAsinOverTwoPi = 0.25;
/// Error of a share by one more factor of a product of unit vectors: the two quotients of the
/// factor turn it by at most 1.5 u, and the product loses at most 2.3 u, divided by 2 pi.
inline constexpr double kTurnError = kDoubleRoundoff;
/// Error of angle_of(). The first term that its series leaves out is below 2^-68 / 17.
inline constexpr double kAngleError = 0x1p-50;
/// Relative error of a sum of three error terms: two additions err by 2 u.
inline constexpr double kWindingErrorInflation = 1 + 0x1p-50;
/// Relative error of a whole number less the share of the triangles at a point, and of that share.
inline constexpr double kStarRounding = 0x1p-52;
/// On the surface: a winding number of a smaller error has a certain sign, or is below 1/4 where
/// its magnitude is below the error.
inline constexpr double kMaxSurfaceWindingError = 0.125;
/// Error of query less centre, as a share of the greatest coordinate: each coordinate errs by u,
/// together sqrt(3) u; doubled.
inline constexpr double kMultipoleQueryRounding = 0x1p-51;
/// Nearer to a box nothing is known of its share. The fourth power of the inverse, 2^240, is far
/// from overflow.
inline constexpr double kMultipoleMinDistance = 0x1p-60;
/// Relative error of a share's error: some 20 operations err by less than 32 u.
inline constexpr double kMultipoleErrorInflation = 1 + 0x1p-40;

// Crossings and the side grid.

/// Error of a . (b x c), as a share of the product of the vectors' greatest components. Each of the
/// six products errs by 8 roundings, three differences, two products and three sums, each of which
/// errs by a whole ulp in a directed mode: 6 * 16 u.
inline constexpr double kCrossingDeterminantError = 0x1p-46;
/// More than flushing subnormals to zero can lose: 2^-1022 times 2^113 and 2^301.
inline constexpr double kCrossingUnderflow = 0x1p-600;
/// Error of a face of the side grid, as a share of its coordinate: a face is rounded once.
inline constexpr double kGridFaceRounding = kDoubleRoundoff;

}  // namespace planetree::octree
