#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "planetree/model.h"
#include "planetree/types.h"
#include "tools/session/touch_probe.h"

namespace planetree::tools {

/// How a simulated tool tip moves. Steps are given as shares of the box's diagonal per tick.
enum class TouchMotion : std::uint8_t {
  kGlide,     ///< along the surface by 0.02 %, alternately a little above and below it
  kScratch,   ///< the same by 0.1 %
  kTeleport,  ///< jumps to another surface point every hundred ticks and stays there
};

/// The motion's name on the command line.
constexpr const char* name_of(TouchMotion motion) {
  return motion == TouchMotion::kGlide     ? "glide"
         : motion == TouchMotion::kScratch ? "scratch"
                                           : "teleport";
}

/// The seed of a path by default.
inline constexpr std::uint64_t kTouchSeed = 20;

inline constexpr std::array<TouchMotion, 3> kAllTouchMotions = {
    TouchMotion::kGlide, TouchMotion::kScratch, TouchMotion::kTeleport};

/// The box around what a tip touches.
struct PathBox {
  Vec3 lower, upper;  ///< model units

  /// That of a model's core.
  static PathBox of(const ModelInfo& info) { return {info.core_lower, info.core_upper}; }
};

/// Called with the number of a tick before its queries, as to move the instances of a scene.
using TickAction = std::function<void(std::size_t)>;

/// The tip's position at each tick, model units. A function of what the probe asks, box, motion,
/// count and seed alone. Makes blocking queries with the probe.
///
/// begin_tick  for each tick; may be empty
std::vector<Vec3> touch_path(TouchProbe probe, const PathBox& box, TouchMotion motion,
                             std::size_t ticks, std::uint64_t seed = kTouchSeed,
                             const TickAction& begin_tick = {});
/// The same on a model.
std::vector<Vec3> touch_path(const Model& model, Probe& probe, TouchMotion motion,
                             std::size_t ticks, std::uint64_t seed = kTouchSeed);

}  // namespace planetree::tools
