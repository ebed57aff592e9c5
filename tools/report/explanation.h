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

/// One answer and how it was found.
struct Explanation {
  Vec3 query;
  ClosestPoint answer;
  query::SideResult side_result;
  bool has_side_layer = true;  ///< or sides do not need it
  query::SideReason reason;
  Vec3 cell_lower, cell_upper;          ///< corners of reason.cell, model units
  Vec3 end;                             ///< reason.end, model units
  Vec3 corners[3];                      ///< of the nearest triangle, model units
  octree::TraversalStats side_work;     ///< work to find the side alone
  octree::TraversalStats nearest_work;  ///< work to find the nearest point alone
  bool pages_lost = false;  ///< pages were unreadable, so that the answer may be degraded
};

/// Reads a point typed as "X,Y,Z". Empty if the text is anything else.
[[nodiscard]] std::optional<Vec3> parse_point(std::string_view text);

/// Opens a file and explains the answer for one point, model units.
///
/// errors  as Model::open
/// memory  up to 256 MiB
[[nodiscard]] Result<Explanation> explain(const std::filesystem::path& path, const Vec3& query);

[[nodiscard]] nlohmann::ordered_json explanation_json(const Explanation& explanation);
[[nodiscard]] std::string explanation_text(const Explanation& explanation);

}  // namespace planetree::tools
