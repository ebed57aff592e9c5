#include "query/scene/scene_state.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <new>
#include <thread>
#include <utility>

#include "octree/geometry/rigid_transform.h"
#include "octree/geometry/startup_check.h"
#include "query/file/scene_frames.h"
#include "query/serve/cache_counts.h"
#include "query/shell/vectors.h"

namespace planetree::query {
namespace {

// Page numbers of a scene: 4 TiB of decoded pages of the default size.
constexpr std::uint32_t kMaxPages = std::uint32_t{1} << 26;

Error bad_argument(const char* text) {
  return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere, "%s", text);
}

Error no_memory(const char* what) {
  return make_error(ErrorCode::kNoMemory, Error::kNowhere, Error::kNowhere,
                    "no memory for %s; free some and try again", what);
}

Result<void> check(const SceneOptions& options) {
  const auto is_out_of = [](std::uint64_t count, std::uint64_t most) {
    return count < 1 || count > most;
  };
  if (is_out_of(options.fetch_threads, OpenOptions::kMaxFetchThreads))
    return bad_argument("fetch_threads of a scene is out of range; give 1 to 64");
  if (is_out_of(options.max_probes, OpenOptions::kMaxProbes))
    return bad_argument("max_probes of a scene is out of range; give 1 to 1024");
  if (is_out_of(options.max_instances, SceneOptions::kMaxInstances))
    return bad_argument("max_instances of a scene is out of range; give 1 to 1048576");
  if (is_out_of(options.max_contacts, SceneOptions::kMaxContacts))
    return bad_argument("max_contacts of a scene is out of range; give 1 to 4096");
  if (!std::has_single_bit(options.max_page_bytes) ||
      options.max_page_bytes < storage::kMinPageBytes ||
      options.max_page_bytes > storage::kMaxPageBytes)
    return bad_argument("max_page_bytes of a scene is a power of two from 4096 to 262144");
  if (options.policy > EvictionPolicy::kTwoQ)
    return bad_argument("the eviction policy does not exist; choose a value of EvictionPolicy");
  return {};
}

}  // namespace

SceneState::Memory SceneState::cut(cache::ArenaLayout& layout, const SceneOptions& options) {
  Memory memory;
  memory.slots = layout.cut<InstanceSlot>(options.max_instances);
  memory.sections = layout.cut<cache::ReaderSlot>(options.max_probes);
  memory.changes = layout.cut<SceneSections::Counter>(1);
  memory.views = layout.cut<InstanceView>(options.max_probes);
  for (unsigned probe = 0; probe < options.max_probes; ++probe) {
    InstanceView measured;
    InstanceView::cut(layout, options.max_instances,
                      memory.views.empty() ? measured : memory.views[probe]);
  }
  memory.contacts = layout.cut<octree::ContactTriangles>(options.max_probes);
  memory.found = layout.cut<ClosestPoint>(std::uint64_t{options.max_probes} * options.max_contacts);
  return memory;
}

cache::CacheLimits SceneState::cache_limits() const noexcept {
  cache::ArenaLayout layout(nullptr);
  cut(layout, options_);
  cache::CacheLimits limits{};
  limits.budget_bytes = options_.memory_budget_bytes;
  limits.page_count = kMaxPages;
  limits.frame_bytes = options_.max_page_bytes;
  limits.policy = options_.policy;
  limits.own_readers = options_.fetch_threads + 1;
  limits.max_readers = limits.own_readers + options_.max_probes;
  limits.is_shared = true;
  limits.reserved_bytes = sizeof(SceneState) +
                          cache::PrefaultedMemory::claimed_bytes(layout.used_bytes()) +
                          options_.fetch_threads * FetchThreads::kThreadBytes;
  return limits;
}

PageFiller::Limits SceneState::filler_limits() const noexcept {
  const std::uint32_t page_bytes = options_.max_page_bytes;
  const std::uint64_t raw_bytes = max_raw_bytes(page_bytes);
  return {std::uint64_t{cache_limits().max_readers} + 1,
          raw_bytes,
          raw_bytes,
          page_bytes,
          std::chrono::milliseconds(options_.wait_limit_ms),
          options_.use_io_uring};
}

Result<std::unique_ptr<SceneState>> SceneState::create(const SceneOptions& options,
                                                       const SceneSeams& seams) {
  if (const auto checked = octree::check_arithmetic(); !checked) return checked.error();
  if (const auto checked = check(options); !checked) return checked.error();
  try {
    std::unique_ptr<SceneState> scene(new SceneState(options, seams));
    if (const auto claimed = scene->claim(); !claimed) return claimed.error();
    if (const auto started = scene->start(); !started) return started.error();
    return scene;
  } catch (const std::bad_alloc&) {
    return no_memory("a scene");
  }
}

Result<void> SceneState::claim() {
  auto pager = ScenePager::create(cache_limits(), filler_limits());
  if (!pager) return pager.error();
  pager_ = std::move(*pager);
  cache::ArenaLayout measure(nullptr);
  cut(measure, options_);
  auto arena = cache::PrefaultedMemory::claim(measure.used_bytes());
  if (!arena) return arena.error();
  arena_.emplace(*std::move(arena));
  cache::ArenaLayout layout(arena_->data());
  memory_ = cut(layout, options_);
  sections_.emplace(memory_.sections, memory_.changes[0]);
  if (options_.locking == Locking::kNever) return {};
  const bool arena_is_locked = arena_->lock(), cache_is_locked = pager_->cache().lock_memory();
  if ((arena_is_locked && cache_is_locked) || options_.locking != Locking::kRequire) return {};
  return no_memory(
      "the scene that the system lets be locked; raise the limit (ulimit -l), lower "
      "the memory budget, or create the scene without locking");
}

Result<void> SceneState::start() {
  for (unsigned i = 0; i <= options_.fetch_threads; ++i) {
    auto reader = pager_->cache().claim_reader();
    if (!reader) return reader.error();
    if (i < options_.fetch_threads)
      fetch_readers_.push_back(*std::move(reader));
    else
      loader_.emplace(*std::move(reader));
  }
  auto threads = FetchThreads::start(pager_->cache(), options_.fetch_threads);
  if (!threads) return threads.error();
  threads_ = std::move(*threads);
  return {};
}

SceneState::~SceneState() {
  threads_.reset();
  for (const auto& model : models_) model->leave(*pager_);
}

SceneModel::Choices SceneState::choices(std::uint32_t layers) const noexcept {
  const std::chrono::milliseconds wait_limit(options_.wait_limit_ms);
  SceneModel::Choices choices;
  choices.layers = layers;
  choices.max_page_bytes = options_.max_page_bytes;
  choices.max_field_bytes = options_.max_field_bytes;
  choices.readers = cache_limits().max_readers;
  choices.fetch_threads = options_.fetch_threads;
  choices.locking = options_.locking;
  choices.query_terms = {false, wait_limit};
  choices.fetcher_terms = {true, wait_limit};
  choices.contacts = memory_.contacts;
  return choices;
}

Result<SceneModel*> SceneState::model_of(const std::filesystem::path& path, std::uint32_t layers) {
  const SceneModel::Choices chosen = choices(layers);
  auto model = SceneModel::open(path, chosen, calls_);
  if (!model) return model.error();
  for (const auto& other : models_)
    if (std::equal(std::begin(other->info.content_id), std::end(other->info.content_id),
                   std::begin((*model)->info.content_id)) &&
        other->info.file_bytes == (*model)->info.file_bytes &&
        other->opened.layers == (*model)->opened.layers)
      return other.get();
  return join(*std::move(model), chosen);
}

Result<SceneModel*> SceneState::join(std::unique_ptr<SceneModel> model,
                                     const SceneModel::Choices& choices) {
  auto joined = model->join(*pager_, *loader_, choices);
  if (joined) {
    try {
      models_.reserve(models_.size() + 1);
      joined = threads_->add(model->serving->arena.fetch_requests,
                             model->fetch_probes(pager_->cache(), options_.fetch_threads), nullptr);
    } catch (const std::bad_alloc&) {
      joined = no_memory("one more model");
    }
  }
  if (!joined) {
    model->leave(*pager_);
    return joined.error();
  }
  models_.push_back(std::move(model));
  return models_.back().get();
}

// No probe uses the model any more.
void SceneState::close(SceneModel& model) noexcept {
  threads_->remove(model.serving->arena.fetch_requests);
  model.leave(*pager_);
  std::erase_if(models_, [&model](const auto& each) { return each.get() == &model; });
}

Result<void> SceneState::check_pose(const SceneModel& model, const Pose& pose,
                                    const Twist& twist) const {
  const auto transform = octree::RigidTransform::of(pose);
  if (!transform)
    return bad_argument("the pose is not valid: give a quaternion of length 1 and finite numbers");
  if (!is_finite(twist.linear) || !is_finite(twist.angular))
    return bad_argument("the twist is not finite");
  if (!transform->is_identity() && !(octree::RigidTransform::is_in_range(model.info.box_lower) &&
                                     octree::RigidTransform::is_in_range(model.info.box_upper)))
    return bad_argument("a model with coordinates above 2^500 cannot be moved");
  return {};
}

Result<InstanceId> SceneState::add(const std::filesystem::path& path, const Pose& pose,
                                   std::uint32_t layers) {
  if ((layers & ~kAllLayers) != 0)
    return bad_argument("the layers of an instance are those of planetree/layers.h");
  const auto free = std::find_if(
      memory_.slots.begin() + first_free_, memory_.slots.end(),
      [](const InstanceSlot& slot) { return !slot.model.load(std::memory_order_relaxed); });
  if (free == memory_.slots.end())
    return make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                      "the scene has %u instances already: create it with a larger max_instances",
                      options_.max_instances);
  const auto model = model_of(path, layers);
  if (!model) return model.error();
  if (const auto checked = check_pose(**model, pose, {}); !checked) {
    if ((*model)->instances == 0) close(**model);
    return checked.error();
  }
  const auto index = static_cast<std::uint32_t>(free - memory_.slots.begin());
  const InstanceId id = instance_id(added_++, index);
  free->placement.store({pose, {}});
  free->id.store(static_cast<std::uint64_t>(id), std::memory_order_relaxed);
  free->model.store(*model, std::memory_order_seq_cst);
  ++(*model)->instances;
  ++instances_;
  first_free_ = index + 1;
  if (index >= used_slots_.load(std::memory_order_relaxed))
    used_slots_.store(index + 1, std::memory_order_release);
  sections_->count_change();
  return id;
}

Result<InstanceSlot*> SceneState::find(InstanceId instance) const noexcept {
  const std::uint32_t index = slot_of(instance);
  if (index < memory_.slots.size()) {
    InstanceSlot& slot = memory_.slots[index];
    if (slot.model.load(std::memory_order_acquire) &&
        slot.id.load(std::memory_order_relaxed) == static_cast<std::uint64_t>(instance))
      return &slot;
  }
  return bad_argument("the scene has no such instance");
}

Result<void> SceneState::remove(InstanceId instance) {
  const auto slot = find(instance);
  if (!slot) return slot.error();
  const SceneModel* const removed = (*slot)->model.load(std::memory_order_relaxed);
  (*slot)->model.store(nullptr, std::memory_order_seq_cst);
  sections_->count_change();
  wait_for_sections();
  --instances_;
  first_free_ = std::min(first_free_, slot_of(instance));
  const auto model = std::find_if(models_.begin(), models_.end(),
                                  [removed](const auto& each) { return each.get() == removed; });
  if (--(*model)->instances == 0) close(**model);
  return {};
}

void SceneState::wait_for_sections() const noexcept {
  for (std::uint32_t probe = 0; probe < sections_->size(); ++probe) {
    const std::uint64_t section = sections_->section_of(probe);
    while (!sections_->is_over(probe, section))
      std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

Result<void> SceneState::set_pose(InstanceId instance, const Pose& pose,
                                  const Twist& twist) noexcept {
  const auto slot = find(instance);
  if (!slot) return slot.error();
  const SceneModel& model = *(*slot)->model.load(std::memory_order_relaxed);
  if (const auto checked = check_pose(model, pose, twist); !checked) return checked;
  (*slot)->placement.store({pose, twist});
  sections_->count_change();
  return {};
}

Result<const ModelInfo*> SceneState::info(InstanceId instance) const noexcept {
  const auto slot = find(instance);
  if (!slot) return slot.error();
  return &(*slot)->model.load(std::memory_order_relaxed)->info;
}

Result<ModelMemory> SceneState::memory(InstanceId instance) const noexcept {
  const auto slot = find(instance);
  if (!slot) return slot.error();
  const SceneModel& model = *(*slot)->model.load(std::memory_order_relaxed);
  return model.memory(choices(model.opened.layers));
}

SceneStats SceneState::stats() const noexcept {
  SceneStats stats;
  report_cache(pager_->cache().stats(), stats);
  stats.instances = instances_;
  stats.models = static_cast<std::uint32_t>(models_.size());
  stats.fetch_requests_served = threads_->fetch_requests_served();
  stats.pages_prefetched = threads_->pages_prefetched();
  for (const auto& model : models_) stats.model_bytes += model->bytes;
  return stats;
}

}  // namespace planetree::query
