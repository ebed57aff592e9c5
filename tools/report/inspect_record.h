#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "tools/report/file_survey.h"
#include "tools/report/page_tally.h"

namespace planetree::tools {

/// What a page about a file is made from.
struct InspectRecord {
  std::string file;
  nlohmann::ordered_json summary;  ///< of summary_json()
  FileSurvey survey;
  PageTally pages;
};

}  // namespace planetree::tools
