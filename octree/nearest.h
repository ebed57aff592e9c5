#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "octree/frame.h"
#include "octree/triangle_distance.h"
#include "planetree/types.h"

namespace planetree::octree {

/// Farther queries need no descent: coordinates of a model are below 2^55, so
/// that taking them off such a query changes no bit of any squared distance,
/// and the nearest triangle is the one of least index.
inline constexpr double kFarthestQuery = 0x1p300;

/// Page number to frame. `page` returns the decoded frame, or null where the
/// page cannot be had; the pointer is good until the next call.
struct PageReader {
  void* context = nullptr;
  const std::byte* (*page)(void* context, std::uint32_t number) noexcept = nullptr;
};

/// What a descent must know of a tree; lengths are in the model frame.
struct TreeFacts {
  std::uint32_t page_bytes = 0;
  std::uint32_t root_link = 0;
  BlockShape shape;
  std::uint64_t record_count = 0;  ///< nodes and blocks together
  Point box_lower = Point::Zero();
  Point box_upper = Point::Zero();
  Point centre = Point::Zero();  ///< boxes and planes are relative to it
  Point sample = Point::Zero();  ///< a vertex of the triangle of least index
  std::uint64_t sample_triangle = 0;
};

/// Limits of one descent; lengths are in the model frame.
struct NearestLimits {
  double max_error = 0;
  double max_distance = std::numeric_limits<double>::infinity();
  std::uint32_t max_nodes = std::numeric_limits<std::uint32_t>::max();
};

/// What a descent did; for tests and benchmarks.
struct NearestWork {
  std::uint64_t nodes = 0;
  std::uint64_t blocks = 0;
  std::uint64_t triangles = 0;  ///< evaluated in double
  std::uint64_t page_turns = 0;
};

/// An answer in the model frame.
struct NearestAnswer {
  double distance = 0;
  double lower = 0;
  double upper = 0;
  Point point = Point::Zero();
  std::uint64_t triangle = kNoTriangle;
  std::array<double, 3> barycentric{};
  Feature feature = Feature::kFace;
  Status status = Status::kBadQuery;
};

/// Nearest surface point to `query`, by depth-first descent, nearest child
/// first.
///
/// query   model frame, no coordinate beyond kFarthestQuery.
/// return  the triangle of least (value, index), value being that of
///         octree/triangle_distance.h, so that an exact answer is a function
///         of tree and query alone. [lower, upper] holds the true distance
///         whatever the status. Pages that cannot be had are leaves with a
///         lower bound: the descent goes on elsewhere, and the answer is still
///         kExact where none of them can matter.
/// threads any; no allocation, no lock, no exception of its own.
/// source  descent and float filter are ours; bounds in octree/bounds.h.
NearestAnswer nearest(const TreeFacts& tree, const Point& query, const NearestLimits& limits,
                      PageReader pages, NearestWork& work) noexcept;

}  // namespace planetree::octree
