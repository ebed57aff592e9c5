// Answers are sound for any model and any query. PLANETREE_TEST_EFFORT in the environment
// multiplies the number of models.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/differential/answer_checks.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"

namespace planetree::oracle {
namespace {

constexpr int kModelsPerFamily = 4;
constexpr int kQueriesPerModel = 60;

struct NastyModel {
  double size;
  BuiltModel built;
};

// Scales so extreme that squares of coordinates overflow or underflow.
double nasty_scale(Random& random) {
  constexpr double kExponents[] = {0, 0, -996, 500, -300, 37};
  const double fraction = random.between(1, 2);
  return std::ldexp(fraction, static_cast<int>(kExponents[random.below(6)]));
}

NastyModel nasty_model(Random& random, const NastyFamily& family) {
  const double size = nasty_scale(random);
  BuildChoices choices;
  if (random.one_in(2)) choices.page_bytes = 4096;
  return {size, BuiltModel(scaled(family.make(random), size), choices)};
}

// Calls check(random, model, query) for many models and queries.
template <class Check>
void each_nasty_case(std::uint64_t seed, const Check& check) {
  const int models = static_cast<int>(kModelsPerFamily * test_effort());
  for (const NastyFamily& family : nasty_families())
    for (int i = 0; i < models; ++i) {
      Random random(seed * 1000003 + static_cast<std::uint64_t>(i));
      NastyModel model = nasty_model(random, family);
      SCOPED_TRACE(std::string(family.name) + " model " + std::to_string(i));
      for (int k = 0; k < kQueriesPerModel && !testing::Test::HasFailure(); ++k)
        check(random, model, nasty_query(random, model.built.triangles(), model.size));
    }
}

TEST(RandomModels, AnswerExactly) {
  each_nasty_case(
      1, [](Random&, NastyModel& model, const Vec3& query) { expect_sound(model.built, query); });
}

TEST(RandomModels, StayWithinMaxError) {
  each_nasty_case(2, [](Random& random, NastyModel& model, const Vec3& query) {
    QueryOptions options;
    options.max_error = model.size * random.magnitude(-52, 2);
    expect_sound(model.built, query, options);
  });
}

TEST(RandomModels, StopAtMaxDistance) {
  each_nasty_case(3, [](Random& random, NastyModel& model, const Vec3& query) {
    const double distance = model.built.closest_point(query).distance;
    QueryOptions options;
    switch (random.below(4)) {
      case 0:
        options.max_distance = distance;
        break;
      case 1:
        options.max_distance = std::nextafter(distance, 0);
        break;
      case 2:
        options.max_distance = distance * random.between(0, 2);
        break;
      default:
        options.max_distance = model.size * random.magnitude(-40, 3);
    }
    if (random.one_in(2)) options.max_error = model.size * random.magnitude(-30, 2);
    const ClosestPoint answer = expect_sound(model.built, query, options);
    if (options.max_distance >= distance && distance > 0x1p-1022) {
      EXPECT_NE(answer.status, Status::kBeyondMaxDistance)
          << distance << ' ' << options.max_distance;
    }
  });
}

TEST(RandomModels, StopAtMaxWork) {
  each_nasty_case(4, [](Random& random, NastyModel& model, const Vec3& query) {
    QueryOptions options;
    options.max_work = static_cast<std::uint32_t>(random.below(12));
    if (random.one_in(3)) options.max_error = model.size * random.magnitude(-30, 2);
    if (random.one_in(3)) options.max_distance = model.size * random.magnitude(-20, 3);
    expect_sound(model.built, query, options);
  });
}

TEST(RandomModels, AnswersAreTheSameInLittleMemoryAndInBatches) {
  for (const NastyFamily& family : nasty_families()) {
    Random random(5);
    const Soup triangles = family.make(random);
    BuiltModel spacious(triangles, {4096});
    BuiltModel cramped(triangles, {4096, std::uint64_t{480} << 10, 1});
    std::vector<Vec3> queries;
    for (int k = 0; k < kQueriesPerModel; ++k) queries.push_back(nasty_query(random, triangles, 1));
    std::vector<ClosestPoint> answers(queries.size());
    cramped.probe().closest_points(queries, answers);
    for (std::size_t k = 0; k < queries.size(); ++k) {
      SCOPED_TRACE(std::string(family.name) + " query " + std::to_string(k));
      expect_same_bits(spacious.closest_point(queries[k]), answers[k]);
      expect_same_bits(spacious.closest_point(queries[k]), cramped.closest_point(queries[k]));
    }
  }
}

}  // namespace
}  // namespace planetree::oracle
