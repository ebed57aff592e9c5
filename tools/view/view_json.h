#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "octree/geometry/triangle_distance.h"
#include "planetree/stats.h"
#include "planetree/types.h"
#include "storage/file/file_layout.h"
#include "tools/tune/trace_timeline.h"
#include "tools/view/page_activity.h"

/// What a model tells the page, as JSON. Numbers that are not finite become null.
namespace planetree::tools {

/// name          of the file, without its folder
/// memory_bytes  of the model, without the page trace
std::string info_json(const std::string& name, const ModelInfo& info,
                      const storage::FileHeader& header, const Stats& stats,
                      std::uint64_t memory_bytes);

/// contacts  those that were found; `are_all`: no other is within `within`
std::string answer_json(const ClosestPoint& answer, std::span<const ClosestPoint> contacts,
                        bool are_all, double within);

std::string stats_json(const Stats& stats, const PageActivity& activity,
                       const storage::FileHeader& header);

/// The windows of a trace, and the pages that were looked up and resident in each. Null: no trace.
std::string timeline_json(const TraceTimeline* timeline);

}  // namespace planetree::tools
