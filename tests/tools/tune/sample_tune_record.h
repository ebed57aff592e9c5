#pragma once

#include <string>

#include "tools/tune/tune_record.h"

namespace planetree::tools {

/// A record of a made trace, with felt budgets and a recommendation.
TuneRecord sample_tune_record(const std::string& trace);

}  // namespace planetree::tools
