#pragma once

#include <chrono>
#include <string>

#include "planetree/model.h"
#include "tools/session/session.h"
#include "tools/session/touch_arguments.h"

namespace planetree::tools {

/// Report of a session, as one JSON object or as text.
std::string touch_json(const TouchArguments& arguments, const TouchRecord& record,
                       const Model& model);
std::string touch_words(const TouchArguments& arguments, const TouchRecord& record,
                        const Model& model);

}  // namespace planetree::tools
