#include "tools/scene/scene_session.h"

#include <chrono>
#include <vector>

#include "tools/scene/scene_motion.h"
#include "tools/scene/world_box.h"
#include "tools/session/session.h"
#include "tools/session/touch_tool.h"

namespace planetree::tools {
namespace {

std::chrono::nanoseconds period_of(const TouchArguments& arguments) {
  return std::chrono::nanoseconds(std::chrono::seconds(1)) /
         static_cast<std::int64_t>(arguments.rate_hz);
}

/// The box around all instances where the scene file puts them.
PathBox box_of(const SceneDescription& description, const OpenedScene& opened) {
  std::vector<WorldBox> boxes;
  for (std::size_t i = 0; i < opened.ids.size(); ++i) {
    const ModelInfo& info = **opened.scene.info(opened.ids[i]);
    boxes.push_back(moved_box(description.instances[i].pose, {info.core_lower, info.core_upper}));
  }
  const WorldBox whole = box_around(boxes);
  return {whole.lower, whole.upper};
}

std::optional<OpenedScene> open_scene(const TouchArguments& arguments,
                                      const SceneDescription& description, SceneFailure& failure) {
  SceneOptions wanted;
  wanted.memory_budget_bytes = arguments.memory_bytes;
  wanted.policy = arguments.policy;
  wanted.use_io_uring = !arguments.no_io_uring;
  return OpenedScene::open(description, arguments.file, wanted, failure);
}

/// The parts of answers that all models tell.
std::uint32_t parts_told_by_all(const SceneDescription& description, const OpenedScene& opened) {
  std::uint32_t parts = kAllParts;
  for (std::size_t i = 0; i < opened.ids.size(); ++i)
    parts &= parts_told_by(description, opened, i);
  return parts;
}

/// What the report of a session shows.
Stats stats_of(const SceneStats& scene) {
  Stats stats;
  stats.page_hits = scene.page_hits;
  stats.page_misses = scene.page_misses;
  stats.pages_read = scene.pages_read;
  stats.pages_evicted = scene.pages_evicted;
  stats.quarantined_pages = scene.quarantined_pages;
  stats.waits_given_up = scene.waits_given_up;
  stats.fetch_requests_served = scene.fetch_requests_served;
  stats.pages_prefetched = scene.pages_prefetched;
  stats.frames = scene.frames;
  stats.arena_bytes = scene.arena_bytes;
  stats.table_bytes = scene.table_bytes + scene.model_bytes;
  stats.budget_bytes = scene.budget_bytes;
  return stats;
}

}  // namespace

std::optional<std::vector<Vec3>> find_scene_path(const TouchArguments& arguments,
                                                 const SceneDescription& description,
                                                 SceneFailure& failure) {
  auto opened = open_scene(arguments, description, failure);
  if (!opened) return std::nullopt;
  failure.file = arguments.file;
  auto probe = SceneProbe::create(opened->scene);
  if (!probe) {
    failure.error = probe.error();
    return std::nullopt;
  }
  const SceneMotion motion(description, *opened, period_of(arguments));
  const std::size_t ticks = arguments.seconds * arguments.rate_hz;
  if (const auto checked = motion.check(ticks); !checked) {
    failure.error = checked.error();
    return std::nullopt;
  }
  return touch_path(*probe, box_of(description, *opened), arguments.motion, ticks, arguments.seed,
                    [&motion](std::size_t tick) { motion.begin_tick(tick); });
}

std::optional<TouchOutcome> run_scene_session(const TouchArguments& arguments,
                                              const SceneDescription& description,
                                              std::span<const Vec3> path, SceneFailure& failure) {
  auto opened = open_scene(arguments, description, failure);
  if (!opened) return std::nullopt;
  auto probe = SceneProbe::create(opened->scene);
  if (!probe) {
    failure = {arguments.file, probe.error()};
    return std::nullopt;
  }
  const SceneMotion motion(description, *opened, period_of(arguments));
  TouchTool tool(box_of(description, *opened), arguments.radius, motion.any_moves());
  TouchOutcome outcome;
  outcome.record = run_touch_session(*probe, tool, path, period_of(arguments),
                                     parts_told_by_all(description, *opened),
                                     [&motion](std::size_t tick) { motion.begin_tick(tick); });
  outcome.stats = stats_of(opened->scene.stats());
  for (std::size_t i = 0; i < opened->ids.size(); ++i) {
    const InstanceDescription& instance = description.instances[i];
    outcome.instances.push_back(
        {opened->ids[i], instance.name, description.models[instance.model].name, motion.moves(i)});
  }
  return outcome;
}

}  // namespace planetree::tools
