#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "planetree/types.h"

namespace planetree::tools {

/// How a simulated tool tip moves. Steps are shares of the model's diagonal a tick.
enum class TouchMotion : std::uint8_t {
  kGlide,     ///< along the surface, 0.02 %, now a little above it and now in it
  kScratch,   ///< the same, 0.1 %
  kTeleport,  ///< to another place at the surface every hundred ticks, and stays there
};

/// As the command line has it.
constexpr const char* name_of(TouchMotion motion) {
  return motion == TouchMotion::kGlide     ? "glide"
         : motion == TouchMotion::kScratch ? "scratch"
                                           : "teleport";
}

inline constexpr std::array<TouchMotion, 3> kAllTouchMotions = {
    TouchMotion::kGlide, TouchMotion::kScratch, TouchMotion::kTeleport};

/// Where the tip is at each tick: the same for the same model, motion and count. Queries the probe,
/// which waits for pages.
std::vector<Vec3> touch_path(const Model& model, Probe& probe, TouchMotion motion,
                             std::size_t ticks);

}  // namespace planetree::tools
