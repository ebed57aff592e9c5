#pragma once

#include "octree/builder/job/build_progress.h"

namespace planetree::octree {

/// Takes no note of a build, and lets it go on.
class SilentProgress final : public BuildProgress {
 public:
  Result<void> progress(BuildPhase, std::uint64_t, std::uint64_t) override { return {}; }
};

}  // namespace planetree::octree
