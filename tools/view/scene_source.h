#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "planetree/scene.h"
#include "tools/scene/opened_scene.h"
#include "tools/view/point_answer.h"
#include "tools/view/scene_layout.h"
#include "tools/view/shape_reader.h"
#include "tools/view/view_source.h"

namespace planetree::tools {

/// A scene as a source: the shapes of its files in the places of its instances, which stand still,
/// and answers by a probe that does not wait for pages. The states of single pages are not known.
class SceneSource final : public ViewSource {
 public:
  /// The page lists all instances, and each is drawn by at least the parts of its root.
  static constexpr std::size_t kMaxInstances = 4096;

  /// file          a scene file
  /// memory_bytes  budget of the scene; empty: what the scene file says
  /// failure       receives what went wrong if nothing is returned
  static std::unique_ptr<SceneSource> open(const std::filesystem::path& file,
                                           std::optional<std::uint64_t> memory_bytes,
                                           SceneFailure& failure);

  std::string info() override { return info_; }
  Result<std::string> shape(const ShapeView& view) override;
  std::string answer(const PointQuestion& question) override;
  std::string stats() override;
  /// Nothing.
  std::string pages() override { return {}; }
  std::string timeline() override;

 private:
  SceneSource(std::string name, SceneDescription description, OpenedScene opened, SceneProbe probe,
              SceneLayout layout);
  std::uint32_t parts_at(const PlacedPoint& answer) const;

  const SceneDescription description_;
  OpenedScene opened_;
  const std::string info_;
  std::mutex probing_;
  SceneProbe probe_;
  std::mutex shaping_;
  ShapeReader shape_;
};

}  // namespace planetree::tools
