#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "tests/oracle/answer_rows.h"

/// Compares answers with every triangle of a mesh that need not fit into memory. One pass over the
/// file, by all threads, in memory that depends on the number of answers alone.
namespace planetree::oracle {

struct JudgeLimits {
  std::size_t round_triangles = std::size_t{1} << 18;  ///< triangles in memory at once
  std::size_t part_triangles = std::size_t{1} << 13;   ///< triangles in one R-tree
  /// Maximum number of solid angles. A side by solid angles needs one for each triangle, in a
  /// second pass.
  std::uint64_t solid_angles = 200'000'000;
};

/// Result of judging.
struct Judgement {
  std::vector<std::string> faults;  ///< one for each answer; empty if there is none
  std::uint64_t triangles = 0;
  std::size_t not_judged = 0;  ///< bad queries
  bool watertight = false;
  std::size_t sides_by_crossings = 0;     ///< exact; watertight meshes only
  std::size_t sides_by_solid_angles = 0;  ///< any mesh; spread over all answers
};

/// Judges distances, intervals and triangles of all answers, and the sides of all if the mesh is
/// watertight. Also judges the sides of every tenth answer by the sum of all solid angles if that
/// is within the limits; for a mesh that is not watertight, of as many answers as the limits allow.
///
/// mesh    coordinates whose squares neither overflow nor underflow
/// errors  as octree::read_mesh()
Result<Judgement> judge_answers(const std::filesystem::path& mesh,
                                std::span<const AnswerRow> answers, const JudgeLimits& limits = {});

}  // namespace planetree::oracle
