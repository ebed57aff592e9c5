#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "planetree/types.h"

/// Query points like those of real programs, made from a seed.
namespace planetree::bench {

/// A model's box.
struct Box {
  Vec3 lower, upper;
  double diagonal() const;
};

/// Answers all parts of a query. Paths need it to stay near the surface.
using SurfaceOf = std::function<ClosestPoint(const Vec3&)>;

enum class Workload {
  kUniform,   ///< anywhere in the box and 10 % around it
  kNear,      ///< within 0.1 % of the diagonal of the surface, all over it
  kPath,      ///< a haptic path: steps of 0.05 % of the diagonal, within 0.2 % of the surface
  kContact,   ///< a contact path: steps of 0.005 %
  kTeleport,  ///< a contact path that restarts elsewhere every 50 steps
  kMedial,    ///< points with two or more equally near surface points
};

inline constexpr Workload kWorkloads[] = {Workload::kUniform,  Workload::kNear,
                                          Workload::kPath,     Workload::kContact,
                                          Workload::kTeleport, Workload::kMedial};

/// The workload's name in options and tables.
std::string name_of(Workload workload);

/// Makes `count` points of a workload on a model. They depend on the arguments alone.
std::vector<Vec3> make_queries(Workload workload, const Box& box, const SurfaceOf& surface,
                               std::size_t count, std::uint64_t seed);

/// Sorts points along a Morton curve through a box.
void sort_on_curve(const Box& box, std::vector<Vec3>& points);

}  // namespace planetree::bench
