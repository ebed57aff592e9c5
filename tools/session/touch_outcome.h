#pragma once

#include <optional>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "planetree/scene.h"
#include "planetree/stats.h"
#include "tools/session/session.h"
#include "tools/trace_file/prefetch_figures.h"

namespace planetree::tools {

/// An instance of a scene that a session touches.
struct TouchInstance {
  InstanceId id = kNoInstance;
  std::string name;    ///< may be empty
  std::string model;   ///< its name
  bool moves = false;  ///< whether it moves during the session
};

/// What a session comes to.
struct TouchOutcome {
  TouchRecord record;
  /// Of the model. Of a scene: what SceneStats has too; tables include those of its models.
  Stats stats;
  std::optional<Error> read_error;  ///< Model::read_error() of the model
  std::optional<PrefetchFigures>
      prefetch;                          ///< what became of prefetched pages, if there is a trace
  Result<void> trace_written;            ///< whether the trace file is complete
  std::vector<TouchInstance> instances;  ///< of a scene, ids ascending; empty: a model
};

}  // namespace planetree::tools
