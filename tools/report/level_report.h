#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/report/file_survey.h"

/// The levels of a file's tree and of its mask.
namespace planetree::tools {

/// `part` / `whole`; 0 if both are 0.
[[nodiscard]] double share(std::uint64_t part, std::uint64_t whole);

[[nodiscard]] nlohmann::ordered_json mask_row_json(const MaskLevelRow& row);

[[nodiscard]] nlohmann::ordered_json levels_json(const FileSurvey& survey);
[[nodiscard]] nlohmann::ordered_json mask_levels_json(const FileSurvey& survey);
[[nodiscard]] std::string levels_text(const FileSurvey& survey);

}  // namespace planetree::tools
