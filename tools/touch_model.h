#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planetree/error.h"
#include "planetree/types.h"
#include "tools/cli/subcommand.h"
#include "tools/session/touch_arguments.h"
#include "tools/session/touch_outcome.h"
#include "tools/trace_file/trace_writer.h"

/// The session of `planetree touch` on a model.
namespace planetree::tools {

/// Finds the tip's path with a model of its own, so that it leaves no page in the session's memory.
/// That model has all layers, so that the path does not depend on those of the session.
Result<std::vector<Vec3>> find_model_path(const TouchArguments& arguments, Console& console);

/// Runs the session, in real time on the real disk or on a simulated disk and clock.
///
/// writer  of the page trace; empty: there is none
Result<TouchOutcome> run_model_session(const TouchArguments& arguments, std::span<const Vec3> path,
                                       std::optional<TraceWriter>& writer);

}  // namespace planetree::tools
