#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "planetree/types.h"

/// Query points that people's programs ask, made from a seed.
namespace planetree::bench {

struct Box {
  Vec3 lower, upper;
  double diagonal() const;
};

/// All parts of the answer to a point, from the library itself: paths hug the surface.
using SurfaceOf = std::function<ClosestPoint(const Vec3&)>;

enum class Workload {
  kUniform,   ///< anywhere in the box and 10 % around it
  kNear,      ///< within 0.1 % of the diagonal of the surface, all over it
  kPath,      ///< a haptic path: steps of 0.05 % of the diagonal, within 0.2 % of the surface
  kContact,   ///< a contact path: steps of 0.005 %
  kTeleport,  ///< a contact path that starts anew elsewhere every 50 steps
  kMedial,    ///< where two or more places of the surface are equally near
};

inline constexpr Workload kWorkloads[] = {Workload::kUniform,  Workload::kNear,
                                          Workload::kPath,     Workload::kContact,
                                          Workload::kTeleport, Workload::kMedial};

std::string name_of(Workload workload);

/// `count` points of a workload on a model.
std::vector<Vec3> make_queries(Workload workload, const Box& box, const SurfaceOf& surface,
                               std::size_t count, std::uint64_t seed);

}  // namespace planetree::bench
