#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "planetree/shard.h"

namespace planetree::tools {

/// A step of a sharded build that has ended, for its report.
struct ShardRecord {
  std::string step;  ///< plan, map or reduce
  const std::filesystem::path& job;
  std::uint32_t shard = 0;  ///< of map and reduce
  double seconds = 0;
};

/// One line of text.
std::string plain_report(const ShardRecord& record, const ShardPlanReport& plan);
std::string plain_report(const ShardRecord& record, const ShardReport& done);
/// One line of JSON.
std::string json_report(const ShardRecord& record, const ShardPlanReport& plan);
std::string json_report(const ShardRecord& record, const ShardReport& done);

}  // namespace planetree::tools
