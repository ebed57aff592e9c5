#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "planetree/types.h"

namespace planetree::tools {

/// A combination of options that trades accuracy for time or memory.
struct TradeSetting {
  double max_error = 0;                             ///< model units
  std::uint32_t max_work = QueryOptions::kNoLimit;  ///< units
  std::uint64_t memory_bytes = 0;
  Wait wait = Wait::kForPages;

  bool is_exact() const {
    return max_error == 0 && max_work == QueryOptions::kNoLimit && wait == Wait::kForPages;
  }
  /// Options of `planetree query` that ask so, without those that have their defaults. Empty if
  /// none is needed.
  std::string options() const;
};

/// Lists the settings to try: exact answers first, then errors, limits of work, and queries that do
/// not wait within little memory.
///
/// diagonal      of the model's core, model units
/// median_edge   model units; 0 if it is not known
/// memory_bytes  of all settings that wait
/// whole_bytes   memory that holds the whole model
std::vector<TradeSetting> trade_settings(double diagonal, double median_edge,
                                         std::uint64_t memory_bytes, std::uint64_t whole_bytes);

}  // namespace planetree::tools
