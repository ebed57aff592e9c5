#include "tools/view/view_json.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "tools/answers/answer_words.h"
#include "tools/cli/subcommand.h"
#include "tools/view/shape_place.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

Json triangle_of(const ClosestPoint& answer) {
  // As text: JavaScript has no 64-bit integers.
  return answer.triangle == kNoTriangle ? Json(nullptr) : Json(std::to_string(answer.triangle));
}

Json point_json(const PlacedPoint& answer, std::uint32_t parts) {
  Json json = {{"distance", number_json(answer.distance)},
               {"lower", number_json(answer.lower)},
               {"upper", number_json(answer.upper)},
               {"point", vector_json(answer.point)},
               {"normal", (parts & kNormal) != 0 ? vector_json(answer.normal) : Json(nullptr)},
               {"triangle", triangle_of(answer)},
               {"feature", feature_word(answer.feature)},
               {"side", side_word(answer.side)},
               {"status", status_word(answer.status)}};
  if (answer.instance != PlacedPoint::kNone) json["instance"] = answer.instance;
  return json;
}

Json counts_json(const PageActivity::Counts& counts) {
  return {{"pages", counts.all()},
          {"resident", counts[PageState::kResident]},
          {"wanted", counts[PageState::kWanted]},
          {"evicted", counts[PageState::kEvicted]}};
}

Json part_json(const char* name, const PageActivity& activity, std::size_t first,
               std::size_t last) {
  const std::size_t pages = activity.states().size();
  Json part = counts_json(activity.count(std::min(first, pages), std::min(last, pages)));
  part["name"] = name;
  return part;
}

Json rows_json(const TraceTimeline& timeline, PageSet TraceTimeline::Window::*set) {
  constexpr std::size_t kMaxRows = 48;
  Json shares = Json::array();
  for (const float share : timeline.shares(set, kMaxRows))
    shares.push_back(std::round(share * 100.0F) / 100.0);
  return {{"rows", timeline.rows(kMaxRows)}, {"shares", std::move(shares)}};
}

}  // namespace

Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json vector_json(const Vec3& value) {
  return {number_json(value.x), number_json(value.y), number_json(value.z)};
}

std::string info_json(const std::string& name, const ModelInfo& info,
                      const storage::FileHeader& header, const Stats& stats,
                      std::uint64_t memory_bytes) {
  const ShapeFrame frame = ShapeFrame::of(header);
  return json_line({{"file", name},
                    {"triangles", info.triangles},
                    {"watertight", info.watertight()},
                    {"side_rule", info.side_rule == SideRule::kSolid ? "solid" : "sheet"},
                    {"has_side_layer", (stats.layers & kSideLayer) != 0},
                    {"box_lower", vector_json(info.box_lower)},
                    {"box_upper", vector_json(info.box_upper)},
                    {"core_lower", vector_json(info.core_lower)},
                    {"core_upper", vector_json(info.core_upper)},
                    {"centre", vector_json(frame.centre)},
                    {"unit", number_json(frame.unit)},
                    {"tree_levels", info.levels},
                    {"nodes", info.nodes},
                    {"blocks", info.blocks},
                    {"pages", info.pages},
                    {"page_bytes", info.page_bytes},
                    {"file_bytes", info.file_bytes},
                    {"memory_bytes", memory_bytes},
                    {"frames", stats.frames}});
}

std::string answer_json(const PointAnswer& answer, double within) {
  Json json = point_json(answer.nearest, answer.parts);
  Json list = Json::array();
  for (const PlacedPoint& contact : answer.contacts)
    list.push_back(point_json(contact, answer.parts));
  json["contacts"] = std::move(list);
  json["contacts_within"] = number_json(within);
  json["contacts_complete"] = answer.are_all;
  return json_line(json);
}

std::string stats_json(const Stats& stats, const PageActivity& activity,
                       const storage::FileHeader& header) {
  const std::size_t pages = activity.states().size();
  const std::size_t tree_end = std::min<std::size_t>(header.first_cap_page(), pages);
  Json levels = Json::array();
  for (const PageActivity::Counts& counts : activity.count_levels(0, tree_end))
    levels.push_back(counts_json(counts));
  Json parts = Json::array();
  parts.push_back(part_json("tree", activity, 0, tree_end));
  parts.push_back(part_json("caps", activity, tree_end, header.first_field_page()));
  parts.push_back(part_json("sides", activity, header.first_mask_page(), pages));
  const PageActivity::Counts all = activity.count(0, pages);
  return json_line({{"changes", activity.changes()},
                    {"resident", all[PageState::kResident]},
                    {"wanted", all[PageState::kWanted]},
                    {"loaded", stats.pages_read},
                    {"evicted", stats.pages_evicted},
                    {"frames", stats.frames},
                    {"page_hits", stats.page_hits},
                    {"page_misses", stats.page_misses},
                    {"degraded_answers", stats.degraded_answers},
                    {"quarantined_pages", stats.quarantined_pages},
                    {"trace_dropped", stats.page_trace_dropped},
                    {"parts", std::move(parts)},
                    {"levels", std::move(levels)}});
}

std::string timeline_json(const TraceTimeline* timeline) {
  if (!timeline) return "null\n";
  Json lookups = Json::array(), misses = Json::array(), degraded = Json::array(),
       resident = Json::array();
  for (const TraceTimeline::Window& window : timeline->windows()) {
    lookups.push_back(window.lookups);
    misses.push_back(window.misses);
    degraded.push_back(window.degraded);
    resident.push_back(window.resident.size());
  }
  return json_line({{"window_ms", static_cast<double>(timeline->window_ns()) / 1e6},
                    {"pages", timeline->pages()},
                    {"lookups", std::move(lookups)},
                    {"misses", std::move(misses)},
                    {"degraded", std::move(degraded)},
                    {"resident_pages", std::move(resident)},
                    {"looked_up", rows_json(*timeline, &TraceTimeline::Window::looked_up)},
                    {"resident", rows_json(*timeline, &TraceTimeline::Window::resident)}});
}

}  // namespace planetree::tools
