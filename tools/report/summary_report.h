#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "tools/check/file_parts.h"
#include "tools/report/file_survey.h"

/// Reports of a whole file for `inspect`.
namespace planetree::tools {

/// Summary of a file. Without a whole header it holds the file's length only.
[[nodiscard]] nlohmann::ordered_json summary_json(const FileParts& parts, const FileSurvey& survey);
[[nodiscard]] std::string summary_text(const std::string& name, const FileParts& parts,
                                       const FileSurvey& survey);

}  // namespace planetree::tools
