#pragma once

#include <string>

#include "tools/session/touch_arguments.h"
#include "tools/session/touch_outcome.h"

namespace planetree::tools {

/// The report of a session as one HTML file: latencies, the session over time, answers, memory and
/// machine. Simulated sessions have no times of queries and nothing of the machine. The size of the
/// page is bounded.
///
/// command  what makes the page again, see touch_command()
std::string touch_page(const TouchArguments& arguments, const TouchOutcome& outcome,
                       const std::string& command);

/// The command that runs the same session and writes the page again, as typed in a shell. Options
/// that have their defaults are left out.
std::string touch_command(const TouchArguments& arguments);

}  // namespace planetree::tools
