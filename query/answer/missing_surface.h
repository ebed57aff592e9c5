#pragma once

#include "octree/nearest/nearest.h"
#include "query/answer/model_geometry.h"

/// The triangles that a file of a region lacks, in answers about the whole input.
namespace planetree::query {

/// Returns a distance that all triangles missing from the file exceed, also as evaluated; infinity
/// if none is missing; 0 for a far query, for which none is known.
double clearance(const ModelGeometry& model, const octree::Point& point, bool far);

/// Corrects an answer for the triangles missing from the file. None of them is nearer than `clear`.
void account_for_missing_surface(const octree::TreeInfo& tree, const octree::Point& point,
                                 double clear, double max_distance, octree::NearestAnswer& nearest);

}  // namespace planetree::query
