#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/session/touch_arguments.h"
#include "tools/session/touch_outcome.h"

namespace planetree::tools {

/// Report of a session, as a JSON object, as its line and as text. Simulated sessions have no times
/// of queries and nothing of the machine. Sessions in scenes have no figure that SceneStats lacks,
/// but the ticks of each instance.
nlohmann::ordered_json touch_report(const TouchArguments& arguments, const TouchOutcome& outcome);
std::string touch_json(const TouchArguments& arguments, const TouchOutcome& outcome);
std::string touch_words(const TouchArguments& arguments, const TouchOutcome& outcome);

}  // namespace planetree::tools
