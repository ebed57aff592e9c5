#pragma once

#include "octree/traversal/tree_view.h"
#include "query/answer/coherence.h"
#include "query/answer/model_geometry.h"

namespace planetree::query {

/// The inputs of a query. The code in this folder knows neither threads nor memory; it gets pages
/// through `pages` only.
struct QueryContext {
  const ModelGeometry& model;
  const octree::PageReader& pages;
  Coherence& coherence;
};

}  // namespace planetree::query
