#include "tools/view/scene_source.h"

#include <utility>

#include "tools/view/scene_facts.h"
#include "tools/view/view_json.h"

namespace planetree::tools {
namespace {

Result<SceneDescription> read_small_scene(const std::filesystem::path& file) {
  auto description = read_scene(file);
  if (!description || description->instances.size() <= SceneSource::kMaxInstances)
    return description;
  return make_error(ErrorCode::kUnsupported, Error::kNowhere, Error::kNowhere,
                    "it has %zu instances, and view shows scenes of up to %zu; view a scene file "
                    "with fewer of them",
                    description->instances.size(), SceneSource::kMaxInstances);
}

}  // namespace

SceneSource::SceneSource(std::string name, SceneDescription description, OpenedScene opened,
                         SceneProbe probe, SceneLayout layout)
    : description_(std::move(description)),
      opened_(std::move(opened)),
      info_(scene_info_json(name, description_, opened_, layout)),
      probe_(std::move(probe)),
      shape_(std::move(layout.files), std::move(layout.instances)) {}

std::unique_ptr<SceneSource> SceneSource::open(const std::filesystem::path& file,
                                               std::optional<std::uint64_t> memory_bytes,
                                               SceneFailure& failure) {
  const auto fail = [&](const Error& error) {
    failure = {file, error};
    return nullptr;
  };
  auto description = read_small_scene(file);
  if (!description) return fail(description.error());
  SceneOptions options;
  options.memory_budget_bytes = description->budget_bytes(memory_bytes);
  auto opened = OpenedScene::open(*description, file, options, failure);
  if (!opened) return nullptr;
  auto probe = SceneProbe::create(opened->scene);
  if (!probe) return fail(probe.error());
  SceneLayout layout;
  if (!layout.read(*description, *opened, failure)) return nullptr;
  return std::unique_ptr<SceneSource>(new SceneSource(file.filename().string(),
                                                      *std::move(description), *std::move(opened),
                                                      *std::move(probe), std::move(layout)));
}

Result<std::string> SceneSource::shape(const ShapeView& view) {
  const std::lock_guard lock(shaping_);
  return shape_.read_bytes(view);
}

/// The parts that the model of an answer tells.
std::uint32_t SceneSource::parts_at(const PlacedPoint& answer) const {
  return answer.instance == PlacedPoint::kNone
             ? kAllParts
             : parts_told_by(description_, opened_, answer.instance);
}

std::string SceneSource::answer(const PointQuestion& question) {
  const auto placed = [this](const SceneClosestPoint& found) {
    PlacedPoint point{found};
    if (found.instance != kNoInstance) point.instance = opened_.index_of(found.instance);
    return point;
  };
  const std::lock_guard lock(probing_);
  PointAnswer answer = ask_at(probe_, question, kAllParts, placed);
  const std::uint32_t parts = parts_at(answer.nearest);
  if (parts != kAllParts) answer = ask_at(probe_, question, parts, placed);
  return answer_json(answer, question.within);
}

std::string SceneSource::stats() { return scene_stats_json(opened_.scene.stats()); }

std::string SceneSource::timeline() { return timeline_json(nullptr); }

}  // namespace planetree::tools
