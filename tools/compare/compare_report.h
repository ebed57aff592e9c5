#pragma once

#include <string>

#include "tools/compare/compare_record.h"

namespace planetree::tools {

/// The record as one JSON object in one line.
[[nodiscard]] std::string compare_json(const CompareRecord& record);

/// The record for people to read.
[[nodiscard]] std::string compare_words(const CompareRecord& record);

/// "1,000 points: 480 inside, 520 outside", and what has no deviation.
[[nodiscard]] std::string counts_text(const CompareRecord& record);

}  // namespace planetree::tools
