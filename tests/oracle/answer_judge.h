#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "planetree/error.h"
#include "tests/oracle/answer_rows.h"

/// Holds answers against every triangle of a mesh that need not fit into memory: one pass over
/// the file, by all threads, in memory that depends on the number of answers alone.
namespace planetree::oracle {

struct JudgeLimits {
  std::size_t round_triangles = std::size_t{1} << 18;  ///< in memory at once
  std::size_t part_triangles = std::size_t{1} << 13;   ///< in one R-tree
  /// Sides by the sum of all solid angles cost an answer each triangle, in a second pass.
  std::uint64_t solid_angles = 200'000'000;
};

/// What was found.
struct Judgement {
  std::vector<std::string> faults;  ///< one an answer: what is wrong with it, or nothing
  std::uint64_t triangles = 0;
  std::size_t not_judged = 0;  ///< answers to queries that make no sense
  bool watertight = false;
  std::size_t sides_by_crossings = 0;     ///< without error, of a watertight mesh
  std::size_t sides_by_solid_angles = 0;  ///< of any mesh, spread over all answers
};

/// Judges distances, intervals and triangles of all answers, the sides of all if the mesh is
/// watertight, and the sides of every tenth by the sum of all solid angles if that is within
/// the limits; of a mesh that is not watertight, of as many as is.
///
/// mesh    of a size whose squares neither overflow nor underflow.
/// errors  those of octree::read_mesh().
Result<Judgement> judge_answers(const std::filesystem::path& mesh,
                                std::span<const AnswerRow> answers, const JudgeLimits& limits = {});

}  // namespace planetree::oracle
