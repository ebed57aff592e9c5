#pragma once

#include "octree/traversal/tree_view.h"
#include "query/answer/coherence.h"
#include "query/answer/model_geometry.h"

namespace planetree::query {

/// What a query works with. The answers know neither threads nor memory: pages come through
/// `pages`, whoever provides them.
struct QueryContext {
  const ModelGeometry& model;
  const octree::PageReader& pages;
  Coherence& coherence;
};

}  // namespace planetree::query
