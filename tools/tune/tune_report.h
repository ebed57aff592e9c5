#pragma once

#include <string>
#include <vector>

#include "tools/tune/tune_record.h"

namespace planetree::tools {

/// The record as text.
std::string tune_words(const TuneRecord& record);

/// The record as one JSON object.
std::string tune_json(const TuneRecord& record);

/// What to set: the budget, the policy and the number of probes. Those of the recommendation, or
/// else of the knee of CLOCK's curve.
struct OptionsToSet {
  std::string purpose;
  std::string in_program;  ///< C++, members of OpenOptions
  std::string on_command_line;
};
OptionsToSet options_to_set(const TuneRecord& record);

}  // namespace planetree::tools
