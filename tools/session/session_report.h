#pragma once

#include <chrono>
#include <string>

#include "planetree/model.h"
#include "tools/session/session.h"
#include "tools/session/touch_arguments.h"

namespace planetree::tools {

/// What a session came to, as one JSON object or in words.
std::string touch_json(const TouchArguments& arguments, const TouchRecord& record,
                       const Model& model);
std::string touch_words(const TouchArguments& arguments, const TouchRecord& record,
                        const Model& model);

}  // namespace planetree::tools
