#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <vector>

#include "cache/prefaulted_memory.h"
#include "planetree/scene.h"
#include "query/scene/instance_table.h"
#include "query/scene/instance_view.h"
#include "query/scene/scene_model.h"
#include "query/scene/scene_pager.h"
#include "query/scene/scene_sections.h"
#include "query/serve/fetch_threads.h"
#include "storage/system/file_calls.h"

namespace planetree::query {

/// Parts of a scene that tests may replace.
struct SceneSeams {
  storage::FileCalls& calls = storage::FileCalls::real();  ///< must outlive the scene
};

/// The implementation of Scene: one cache and one set of fetch threads for all models.
class SceneState {
 public:
  ~SceneState();
  SceneState(const SceneState&) = delete;
  SceneState& operator=(const SceneState&) = delete;

  /// See the functions of Scene. Require the default floating-point mode, see FpEnvironmentGuard.
  static Result<std::unique_ptr<SceneState>> create(const SceneOptions& options,
                                                    const SceneSeams& seams = {});
  Result<InstanceId> add(const std::filesystem::path& path, const Pose& pose, std::uint32_t layers);
  Result<void> remove(InstanceId instance);
  Result<void> set_pose(InstanceId instance, const Pose& pose, const Twist& twist) noexcept;
  Result<const ModelInfo*> info(InstanceId instance) const noexcept;
  Result<ModelMemory> memory(InstanceId instance) const noexcept;
  SceneStats stats() const noexcept;

  /// Returns the reader of a new probe, or kBadArgument if all are in use.
  Result<cache::Reader> claim_probe() const noexcept { return pager_->cache().claim_reader(); }
  /// The number of the probe that has this reader: the first readers are those of the scene.
  std::uint32_t probe_of(const cache::Reader& reader) const noexcept {
    return reader.index() - options_.fetch_threads - 1;
  }
  const SceneSections& sections() const noexcept { return *sections_; }
  /// The view of the probe with this number.
  InstanceView& view(std::uint32_t probe) const noexcept { return memory_.views[probe]; }
  /// Memory of the probe with this number for the contacts of one instance.
  std::span<ClosestPoint> found(std::uint32_t probe) const noexcept {
    return memory_.found.subspan(std::size_t{probe} * options_.max_contacts, options_.max_contacts);
  }
  /// The slots that may have instances.
  std::span<const InstanceSlot> slots() const noexcept {
    return memory_.slots.first(used_slots_.load(std::memory_order_acquire));
  }

 private:
  // Memory that queries read and write, besides that of the models.
  struct Memory {
    std::span<InstanceSlot> slots;
    std::span<cache::ReaderSlot> sections;
    std::span<SceneSections::Counter> changes;     // one
    std::span<InstanceView> views;                 // one for each probe
    std::span<octree::ContactTriangles> contacts;  // one for each probe
    std::span<ClosestPoint> found;                 // max_contacts for each probe
  };

  explicit SceneState(const SceneOptions& options, const SceneSeams& seams)
      : options_(options), calls_(seams.calls) {}
  static Memory cut(cache::ArenaLayout& layout, const SceneOptions& options);
  Result<void> claim();
  Result<void> start();
  cache::CacheLimits cache_limits() const noexcept;
  PageFiller::Limits filler_limits() const noexcept;
  SceneModel::Choices choices(std::uint32_t layers) const noexcept;
  Result<SceneModel*> model_of(const std::filesystem::path& path, std::uint32_t layers);
  Result<SceneModel*> join(std::unique_ptr<SceneModel> model, const SceneModel::Choices& choices);
  void close(SceneModel& model) noexcept;
  Result<void> check_pose(const SceneModel& model, const Pose& pose, const Twist& twist) const;
  Result<InstanceSlot*> find(InstanceId instance) const noexcept;
  void wait_for_sections() const noexcept;

  const SceneOptions options_;
  storage::FileCalls& calls_;
  std::optional<cache::PrefaultedMemory> arena_;
  Memory memory_;
  std::optional<SceneSections> sections_;
  std::atomic<std::uint32_t> used_slots_{0};
  std::uint32_t added_ = 0;  // instances so far
  std::uint32_t instances_ = 0;
  std::uint32_t first_free_ = 0;  // all slots below have instances
  std::unique_ptr<ScenePager> pager_;
  std::vector<cache::Reader> fetch_readers_;  // with the indices from 0 on
  std::optional<cache::Reader> loader_;       // reads grids and fields of files that are added
  std::vector<std::unique_ptr<SceneModel>> models_;
  std::unique_ptr<FetchThreads> threads_;
};

}  // namespace planetree::query
