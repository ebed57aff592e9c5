#pragma once

#include "planetree/model.h"

namespace planetree::tools {

/// The diagonal of a model's box, in model units. 1 if the box is a point or too large for a
/// double, so that lengths can be divided by it.
[[nodiscard]] double box_diagonal(const ModelInfo& info);

/// The greatest coordinate of a model's box without its sign, or the diagonal if that is more.
[[nodiscard]] double greatest_coordinate(const ModelInfo& info);

}  // namespace planetree::tools
