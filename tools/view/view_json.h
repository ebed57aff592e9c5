#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "octree/geometry/triangle_distance.h"
#include "planetree/stats.h"
#include "planetree/types.h"
#include "storage/file/file_layout.h"
#include "tools/tune/trace_timeline.h"
#include "tools/view/page_activity.h"
#include "tools/view/point_answer.h"

/// What a model tells the page, and answers of models and scenes, as JSON. Numbers that are not
/// finite become null.
namespace planetree::tools {

nlohmann::ordered_json number_json(double value);
nlohmann::ordered_json vector_json(const Vec3& value);

/// name          of the file, without its folder
/// memory_bytes  of the model, without the page trace
std::string info_json(const std::string& name, const ModelInfo& info,
                      const storage::FileHeader& header, const Stats& stats,
                      std::uint64_t memory_bytes);

/// within  distance up to which contacts were asked for
std::string answer_json(const PointAnswer& answer, double within);

std::string stats_json(const Stats& stats, const PageActivity& activity,
                       const storage::FileHeader& header);

/// The windows of a trace, and the pages that were looked up and resident in each. Null: no trace.
std::string timeline_json(const TraceTimeline* timeline);

}  // namespace planetree::tools
