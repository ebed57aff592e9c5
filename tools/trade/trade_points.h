#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "planetree/model.h"
#include "planetree/probe.h"
#include "planetree/types.h"

namespace planetree::tools {

/// Where query points are.
enum class TradeWorkload : std::uint8_t {
  kUniform,  ///< anywhere in the core's box and a tenth of its edges around it
  kNear,     ///< within 0.1 % of the core's diagonal of the surface, all over it
  kPath,     ///< one behind the other along the surface, see TouchMotion::kScratch
  kGiven,    ///< those of a file
};

/// The workload's name in reports.
const char* name_of(TradeWorkload workload);

/// Workloads that are made rather than read.
inline constexpr std::array<TradeWorkload, 3> kMadeWorkloads = {
    TradeWorkload::kUniform, TradeWorkload::kNear, TradeWorkload::kPath};

/// Length of the diagonal of the model's core, model units.
double core_diagonal(const ModelInfo& info);

/// Makes query points. A function of model, workload and count alone. Makes blocking queries with
/// the probe.
///
/// workload  one of kMadeWorkloads
std::vector<Vec3> trade_points(const Model& model, Probe& probe, TradeWorkload workload,
                               std::size_t count);

}  // namespace planetree::tools
