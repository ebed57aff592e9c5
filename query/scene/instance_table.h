#pragma once

#include <atomic>
#include <cstdint>
#include <span>

#include "planetree/pose.h"
#include "planetree/scene.h"
#include "query/serve/seq_lock.h"

namespace planetree::query {

struct SceneModel;

/// Where an instance is and how it moves.
struct Placement {
  Pose pose;
  Twist twist;
};

/// A place for an instance in a scene. One thread at a time changes `model` and `id`, another one
/// `placement`; probes read them inside of their sections.
struct InstanceSlot {
  /// Null: there is no instance.
  std::atomic<const SceneModel*> model{nullptr};
  /// Of the instance; written before `model`.
  std::atomic<std::uint64_t> id{0};
  SeqLock<Placement> placement;
};

/// The low half of an InstanceId is the index of its slot, the high half counts instances, so that
/// greater values were added later and no value occurs twice.
inline std::uint32_t slot_of(InstanceId id) noexcept {
  return static_cast<std::uint32_t>(static_cast<std::uint64_t>(id));
}
inline InstanceId instance_id(std::uint32_t count, std::uint32_t slot) noexcept {
  return InstanceId{std::uint64_t{count} << 32 | slot};
}

}  // namespace planetree::query
