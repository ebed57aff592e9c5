#pragma once

#include <cstdint>
#include <optional>

#include "octree/nearest/front_side.h"
#include "octree/nearest/nearest.h"
#include "octree/traversal/tree_view.h"
#include "query/answer/model_geometry.h"
#include "query/answer/side.h"

/// Sides by SideRule::kSurface.
namespace planetree::query {

/// Returns whether the nearest triangle is known, as far as distances computed in double tell.
bool is_proven(const octree::TreeInfo& tree, const octree::NearestAnswer& nearest) noexcept;

/// Returns where a query is if the nearest feature need not decide, or cannot because it is
/// uncertain by rounding: on the surface, or so near to it that all triangles there are looked at.
/// Else returns nothing.
///
/// nearest   the query's answer, which names a triangle; model frame
/// max_work  maximum work in units, see octree::WorkLimit
std::optional<octree::Front> front_at_surface(
    const octree::TreeInfo& tree, const octree::Point& query, const octree::NearestAnswer& nearest,
    std::uint64_t max_work, const octree::PageReader& pages, octree::TraversalStats& work) noexcept;

/// Returns the side: kDegraded if it is unknown.
SideResult side_of(octree::Front front) noexcept;

}  // namespace planetree::query
