#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "tools/session/touch_arguments.h"
#include "tools/session/touch_outcome.h"

/// The answers of a session in a scene by instance.
namespace planetree::tools {

/// The position of an instance among `instances`, whose ids ascend; their number if it is none.
std::size_t position_of(InstanceId id, std::span<const TouchInstance> instances);

/// How many ticks each instance answered: it was the nearest or, with a ball, stopped the ball.
class InstanceTally {
 public:
  explicit InstanceTally(const TouchOutcome& outcome);

  /// By position.
  const std::vector<std::uint64_t>& ticks() const { return ticks_; }
  /// Ticks that none answered.
  std::uint64_t none() const { return none_; }
  /// Positions of those with the most ticks, at least one; of equal ones the first in the file.
  std::vector<std::size_t> leading(std::size_t most) const;

 private:
  std::vector<std::uint64_t> ticks_;
  std::uint64_t none_ = 0;
};

/// All instances in the order of the file, as a list of JSON objects.
nlohmann::ordered_json instances_json(const TouchOutcome& outcome);
/// Lines about the instances with the most ticks.
std::string instances_words(const TouchArguments& arguments, const TouchOutcome& outcome);
/// A section of a page about the instances with the most ticks.
std::string instances_section(const TouchArguments& arguments, const TouchOutcome& outcome);

}  // namespace planetree::tools
