#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "planetree/build.h"

namespace planetree::tools {

/// A build that has ended, for its report.
struct BuildRecord {
  const std::filesystem::path& input;
  const std::filesystem::path& output;
  const BuildReport& built;
  double seconds = 0;                              ///< of the whole build, above 0
  const nlohmann::ordered_json& seconds_by_phase;  ///< in the order of phases
};

/// Reports a build as one line of JSON.
///
/// sha256  of the file
std::string json_report(const BuildRecord& record, const std::string& sha256);
/// Reports a build as a line of text.
std::string plain_report(const BuildRecord& record);

}  // namespace planetree::tools
