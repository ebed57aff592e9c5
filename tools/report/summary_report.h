#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/check/file_parts.h"
#include "tools/report/file_survey.h"

/// A whole file as `inspect` shows it.
namespace planetree::tools {

/// Only what can be known: a file without a whole header has but its length.
[[nodiscard]] nlohmann::ordered_json summary_json(const FileParts& parts, const FileSurvey& survey);
[[nodiscard]] std::string summary_text(const std::string& name, const FileParts& parts,
                                       const FileSurvey& survey);

[[nodiscard]] nlohmann::ordered_json levels_json(const FileSurvey& survey);
[[nodiscard]] nlohmann::ordered_json mask_levels_json(const FileSurvey& survey);
[[nodiscard]] std::string levels_text(const FileSurvey& survey);

}  // namespace planetree::tools
