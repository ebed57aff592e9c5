#pragma once

#include <string>

#include "tools/thickness/thickness_record.h"

namespace planetree::tools {

/// The record as one JSON object in one line.
[[nodiscard]] std::string thickness_json(const ThicknessRecord& record);

/// The record for people to read.
[[nodiscard]] std::string thickness_words(const ThicknessRecord& record);

/// "1,000 points: 990 exact, 10 bounded".
[[nodiscard]] std::string counts_text(const ThicknessRecord& record);

}  // namespace planetree::tools
