#include "tests/oracle/answer_judge.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include <tbb/parallel_for.h>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/surface/edge_sum.h"
#include "tests/oracle/answer_evidence.h"
#include "tests/oracle/queries/triangle_part.h"
#include "tests/oracle/triangle_rounds.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

// One answer out of this many has its side judged by solid angles, within the limits.
constexpr std::size_t kSolidAnglesOfEach = 10;

// A bad query has no answer to judge.
bool is_judged(const AnswerRow& answer) { return answer.status != Status::kBadQuery; }
bool has_finite_query(const AnswerRow& answer) {
  return is_judged(answer) && is_finite(answer.query);
}

octree::Triangle points_of(const Corners& t) {
  return {octree::Point(t[0].x, t[0].y, t[0].z), octree::Point(t[1].x, t[1].y, t[1].z),
          octree::Point(t[2].x, t[2].y, t[2].z)};
}

// Collects, for each answer, evidence from the triangles that its ball and its ray may meet.
class EvidenceCollector final : public TriangleRounds {
 public:
  EvidenceCollector(std::span<const AnswerRow> answers, const JudgeLimits& limits)
      : TriangleRounds(limits.round_triangles), answers_(answers), limits_(limits) {
    for (const AnswerRow& answer : answers) evidence_.emplace_back(answer);
  }

  [[nodiscard]] const std::vector<AnswerEvidence>& evidence() const { return evidence_; }
  [[nodiscard]] bool is_watertight() const { return edges_.is_watertight(); }

 private:
  struct Part {
    std::size_t first;
    TrianglePart triangles;
  };
  struct Round {
    std::span<const Corners> triangles;
    std::span<const std::uint64_t> indices;
    std::vector<Part> parts;
  };

  void take(std::span<const Corners> triangles, std::span<const std::uint64_t> indices) override {
    const Round round{triangles, indices, parts_of(triangles)};
    tbb::parallel_for(std::size_t{0}, answers_.size(), [&](std::size_t i) {
      if (has_finite_query(answers_[i])) collect(round, answers_[i], evidence_[i]);
    });
  }

  std::vector<Part> parts_of(std::span<const Corners> triangles) {
    const std::size_t count = (triangles.size() - 1) / limits_.part_triangles + 1;
    std::vector<std::optional<Part>> made(count);
    tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
      const std::size_t first = i * limits_.part_triangles;
      const auto part = triangles.subspan(first).first(
          std::min(limits_.part_triangles, triangles.size() - first));
      made[i].emplace(Part{first, TrianglePart(part)});
      sum_edges(part);
    });
    std::vector<Part> parts;
    for (std::optional<Part>& part : made) parts.push_back(std::move(*part));
    return parts;
  }

  void sum_edges(std::span<const Corners> triangles) {
    octree::EdgeSum sum;
    for (const Corners& triangle : triangles) sum.add(points_of(triangle));
    const std::lock_guard lock(mutex_);
    edges_.add(sum);
  }

  static void collect(const Round& round, const AnswerRow& answer, AnswerEvidence& evidence) {
    const auto named = std::ranges::lower_bound(round.indices, answer.triangle);
    if (named != round.indices.end() && *named == answer.triangle)
      evidence.add_named(round.triangles[static_cast<std::size_t>(named - round.indices.begin())]);
    thread_local std::vector<std::uint32_t> found;
    for (const Part& part : round.parts) {
      found.clear();
      part.triangles.find_near(answer.query, evidence.reach(), found);
      for (const std::uint32_t index : found)
        evidence.add_near(round.indices[part.first + index], round.triangles[part.first + index]);
      found.clear();
      part.triangles.find_ahead(answer.query, found);
      for (const std::uint32_t index : found)
        evidence.add_ahead(round.triangles[part.first + index]);
    }
  }

  std::span<const AnswerRow> answers_;
  JudgeLimits limits_;
  std::vector<AnswerEvidence> evidence_;
  std::mutex mutex_;
  octree::EdgeSum edges_;
};

// Sums the winding numbers of some answers, triangle by triangle.
class SolidAngles final : public TriangleRounds {
 public:
  SolidAngles(std::vector<const AnswerRow*> answers, std::size_t round_triangles)
      : TriangleRounds(round_triangles), answers_(std::move(answers)), windings_(answers_.size()) {}

  // Fault of the side of one answer; empty if there is none, or if the winding number is too near a
  // half to decide.
  [[nodiscard]] std::string side_fault(std::size_t i) const {
    if (windings_[i].on_surface) return oracle::side_fault(*answers_[i], Side::kOnSurface);
    const long double over = std::fabs(windings_[i].value) - 0.5L;
    if (std::fabs(over) < 1e-6L) return {};
    return oracle::side_fault(*answers_[i], over > 0 ? Side::kInside : Side::kOutside);
  }

 private:
  void take(std::span<const Corners> triangles, std::span<const std::uint64_t>) override {
    tbb::parallel_for(std::size_t{0}, answers_.size(), [&](std::size_t i) {
      const OpenWinding winding = open_winding(answers_[i]->query, triangles);
      windings_[i].value += winding.value;
      windings_[i].on_surface = windings_[i].on_surface || winding.on_surface;
    });
  }

  std::vector<const AnswerRow*> answers_;
  std::vector<OpenWinding> windings_;
};

// Indices of the answers whose sides are to be computed from all solid angles.
std::vector<std::size_t> chosen(std::span<const AnswerRow> answers, const Judgement& judgement,
                                const JudgeLimits& limits) {
  const std::uint64_t affordable =
      limits.solid_angles / std::max<std::uint64_t>(1, judgement.triangles);
  const std::size_t wanted = (answers.size() + kSolidAnglesOfEach - 1) / kSolidAnglesOfEach;
  if (affordable == 0 || (judgement.watertight && affordable < wanted)) return {};
  std::size_t step = kSolidAnglesOfEach;
  while ((answers.size() + step - 1) / step > affordable) ++step;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < answers.size(); i += step)
    if (has_finite_query(answers[i])) indices.push_back(i);
  return indices;
}

Result<void> judge_solid_angles(const std::filesystem::path& mesh,
                                std::span<const AnswerRow> answers, const JudgeLimits& limits,
                                Judgement& judgement) {
  const std::vector<std::size_t> indices = chosen(answers, judgement, limits);
  if (indices.empty()) return {};
  std::vector<const AnswerRow*> chosen_rows;
  for (const std::size_t i : indices) chosen_rows.push_back(&answers[i]);
  SolidAngles angles(std::move(chosen_rows), limits.round_triangles);
  if (const auto read = octree::read_mesh(mesh, angles); !read) return read.error();
  angles.finish();
  for (std::size_t k = 0; k < indices.size(); ++k)
    if (std::string& fault = judgement.faults[indices[k]]; fault.empty())
      fault = angles.side_fault(k);
  judgement.sides_by_solid_angles = indices.size();
  return {};
}

}  // namespace

Result<Judgement> judge_answers(const std::filesystem::path& mesh,
                                std::span<const AnswerRow> answers, const JudgeLimits& limits) {
  EvidenceCollector collector(answers, limits);
  if (const auto read = octree::read_mesh(mesh, collector); !read) return read.error();
  collector.finish();
  Judgement judgement;
  judgement.triangles = collector.triangle_count();
  judgement.watertight = collector.is_watertight();
  for (std::size_t i = 0; i < answers.size(); ++i) {
    std::string& fault = judgement.faults.emplace_back();
    if (!is_judged(answers[i])) {
      ++judgement.not_judged;
      continue;
    }
    fault = collector.evidence()[i].fault();
    if (judgement.watertight && fault.empty()) fault = collector.evidence()[i].side_fault();
    judgement.sides_by_crossings += judgement.watertight;
  }
  if (const auto done = judge_solid_angles(mesh, answers, limits, judgement); !done)
    return done.error();
  return judgement;
}

}  // namespace planetree::oracle
