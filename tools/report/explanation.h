#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "octree/nearest/nearest.h"
#include "planetree/error.h"
#include "planetree/types.h"
#include "query/answer/side.h"

namespace planetree::tools {

/// One answer and how it came about.
struct Explanation {
  Vec3 query;
  ClosestPoint answer;
  query::SideResult side_result;
  query::SideReason reason;
  Vec3 cell_lower, cell_upper;          ///< of reason.cell, model units
  Vec3 end;                             ///< reason.end, model units
  Vec3 corners[3];                      ///< of the nearest triangle, model units
  octree::TraversalStats side_work;     ///< what finding the side took, by itself,
  octree::TraversalStats nearest_work;  ///< and the nearest point
  bool pages_lost = false;  ///< some could not be read, so that the answer may be less exact
};

/// "X,Y,Z" as typed.
[[nodiscard]] std::optional<Vec3> parse_point(std::string_view text);

/// Queries the file at `path` about one point, model units.
///
/// memory  256 MiB of pages at most
[[nodiscard]] Result<Explanation> explain(const std::filesystem::path& path, const Vec3& query);

[[nodiscard]] nlohmann::ordered_json explanation_json(const Explanation& explanation);
[[nodiscard]] std::string explanation_text(const Explanation& explanation);

}  // namespace planetree::tools
