// What a probe keeps from earlier queries changes no later answer.

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

#include "tests/oracle/built_model.h"
#include "tests/oracle/closed_models.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"
#include "tests/query/answer_bits.h"

namespace planetree::oracle {
namespace {

constexpr BuildChoices kTwoProbes{4096, std::uint64_t{8} << 20, 2};
constexpr std::size_t kStretches = 12;  // stretches of a path, each with another start
constexpr std::size_t kStretchSteps = 25;

// A path along a surface, near it and through it, with points on the faces of mask cells.
std::vector<Vec3> surface_path(Random& random, const Soup& triangles) {
  std::vector<Vec3> path;
  for (std::size_t stretch = 0; stretch < 8 * kStretches; ++stretch) {
    const double step = random.magnitude(-10, -3);
    const double lattice = random.one_in(2) ? 0x1p-6 : 0x1p-30;
    Vec3 at = point_on(random, triangles[random.below(triangles.size())]);
    for (std::size_t i = 0; i < kStretchSteps; ++i) {
      at = at + random.in_cube() * step;
      path.push_back({std::round(at.x / lattice) * lattice, std::round(at.y / lattice) * lattice,
                      std::round(at.z / lattice) * lattice});
    }
  }
  return path;
}

// A path from nasty points, with steps of every length; some steps are zero.
std::vector<Vec3> nasty_path(Random& random, const Soup& triangles) {
  std::vector<Vec3> path;
  for (std::size_t stretch = 0; stretch < kStretches; ++stretch) {
    Vec3 at = nasty_query(random, triangles, 1);
    const double step = random.magnitude(-50, 0);
    for (std::size_t i = 0; i < kStretchSteps; ++i) {
      path.push_back(at);
      if (!random.one_in(8)) at = at + random.in_cube() * step;
    }
  }
  return path;
}

Probe new_probe(const Model& model) {
  auto probe = Probe::create(model);
  if (!probe) std::abort();
  return *std::move(probe);
}

// With limits a probe may answer better than a new one, by its earlier queries.
void expect_sound(Probe& probe, Probe& fresh, const Vec3& query, const QueryOptions& options) {
  const ClosestPoint exact = fresh.closest_point(query);
  const ClosestPoint found = probe.closest_point(query, options);
  if ((options.parts & kSide) != 0) {
    ASSERT_TRUE(found.side == exact.side || found.side == Side::kUnknown);
  }
  if ((options.parts & kDistance) == 0 || found.status == Status::kBeyondMaxDistance) return;
  ASSERT_LE(found.lower, exact.upper);
  ASSERT_GE(found.upper, exact.lower);
  if (found.status == Status::kExact && options.parts == kAllParts) {
    ASSERT_EQ(bits_of(found), bits_of(exact));
  }
  if (found.status == Status::kWithinError) {
    ASSERT_LE(found.upper - found.lower, options.max_error);
  }
}

// Queries various parts along a path, with one probe throughout and with a new probe each time.
void expect_same_as_new(const Soup& soup, const std::vector<Vec3>& path, Random& random) {
  BuiltModel built(soup, kTwoProbes);
  for (const Vec3& query : path) {
    Probe fresh = new_probe(built.model());
    if (random.one_in(3)) {
      const Containment expected = fresh.contains(query), found = built.probe().contains(query);
      ASSERT_EQ(found.side, expected.side);
      ASSERT_EQ(found.status, expected.status);
      continue;
    }
    constexpr std::uint32_t kParts[] = {kDistance, kSide, kDistance | kSide, kAllParts};
    QueryOptions options;
    options.parts = kParts[random.below(4)];
    if (random.one_in(6)) options.max_distance = random.magnitude(-10, 1);
    if (random.one_in(6)) {
      options.max_work = static_cast<std::uint32_t>(random.below(40));
      expect_sound(built.probe(), fresh, query, options);
      continue;
    }
    const ClosestPoint expected = fresh.closest_point(query, options);
    ASSERT_EQ(bits_of(built.probe().closest_point(query, options)), bits_of(expected))
        << query.x << ' ' << query.y << ' ' << query.z << " parts " << options.parts;
    if (random.one_in(6)) {
      options.max_error = random.magnitude(-20, -1);
      expect_sound(built.probe(), fresh, query, options);
    }
  }
}

void expect_same_for_all(std::span<const NastyFamily> families, std::uint64_t seed) {
  for (const NastyFamily& family : families) {
    SCOPED_TRACE(std::string(family.name));
    Random random(seed);
    const auto models = static_cast<int>(4 * test_effort());
    for (int i = 0; i < models && !testing::Test::HasFatalFailure(); ++i) {
      const Soup soup = family.make(random);
      expect_same_as_new(soup, nasty_path(random, soup), random);
    }
  }
}

TEST(ProbeCoherence, ChangesNoAnswerOfNastyModels) { expect_same_for_all(nasty_families(), 12); }

TEST(ProbeCoherence, ChangesNoAnswerOfClosedModels) { expect_same_for_all(closed_families(), 13); }

// Winding numbers of 2, of 0 within a solid, and more triangles than are kept at once.
TEST(ProbeCoherence, ChangesNoAnswerAlongASurface) {
  Random random(14);
  const Soup twice = ball(5) + translated(scaled(ball(5), 0.75), {0.5, 0.25, 0});
  const Soup hollow = ball(5) + inside_out(scaled(ball(4), 0.5));
  const Soup nested = ball(4) + scaled(ball(5), 0.75);
  for (const Soup& soup : {twice, hollow, nested, ball(3)})
    expect_same_as_new(soup, surface_path(random, soup), random);
}

}  // namespace
}  // namespace planetree::oracle
