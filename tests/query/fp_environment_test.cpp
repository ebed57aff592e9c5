// The floating-point mode of the calling thread changes no bit of any answer.

#include "octree/geometry/fp_environment.h"

#include <gtest/gtest.h>

#include <cfenv>
#include <functional>
#include <vector>

#include "tests/octree/support/odd_arithmetic.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

namespace planetree::query {
namespace {

// The answers of every query function of a probe, as bits.
class StabilityHostThread : public testing::Test {
 protected:
  StabilityHostThread()
      : sample_(SampleModel::masked(octree::sphere(3))),
        model_(sample_.open()),
        queries_(random_queries(300, -1.3, 1.3)) {
    queries_.push_back({0x1p-1074, 0x1p-1060, 0});
    queries_.push_back({1e300, -1e300, 1});
  }

  using Bits = std::vector<std::uint64_t>;
  static void add(const ClosestPoint& answer, Bits& bits) {
    for (const std::uint64_t word : bits_of(answer)) bits.push_back(word);
  }
  static void add(const Containment& answer, Bits& bits) {
    bits.push_back(static_cast<std::uint64_t>(answer.side));
    bits.push_back(static_cast<std::uint64_t>(answer.status));
  }

  Bits one_by_one(bool sides) const {
    Probe probe = make_probe(model_);
    Bits bits;
    for (const Vec3& query : queries_) {
      if (sides)
        add(probe.contains(query), bits);
      else
        add(probe.closest_point(query), bits);
    }
    return bits;
  }
  template <class Answer>
  Bits in_a_batch(void (Probe::*query_function)(std::span<const Vec3>, std::span<Answer>,
                                                const QueryOptions&) noexcept) const {
    Probe probe = make_probe(model_);
    std::vector<Answer> answers(queries_.size());
    (probe.*query_function)(queries_, answers, {});
    Bits bits;
    for (const Answer& answer : answers) add(answer, bits);
    return bits;
  }

  std::vector<std::function<Bits()>> query_functions() const {
    return {[this] { return one_by_one(false); }, [this] { return one_by_one(true); },
            [this] { return in_a_batch<ClosestPoint>(&Probe::closest_points); },
            [this] { return in_a_batch<Containment>(&Probe::contains); }};
  }

  SampleModel sample_;
  Model model_;
  std::vector<Vec3> queries_;
};

constexpr int kRoundings[] = {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO};

TEST_F(StabilityHostThread, AnswersIgnoreRoundingModeAndFlushToZero) {
  for (const auto& query_function : query_functions()) {
    const Bits expected = query_function();
    for (const int rounding : kRoundings) {
      const OddArithmetic odd(rounding);
      EXPECT_EQ(query_function(), expected) << rounding;
      EXPECT_EQ(std::fegetround(), rounding);
    }
  }
}

// A model opened in another rounding mode gives the same answers.
TEST_F(StabilityHostThread, ModelOpenedInAnotherRoundingModeGivesTheSameAnswers) {
  for (const int rounding : kRoundings) {
    const auto open = [&] {
      const OddArithmetic odd(rounding);
      return Model::open(sample_.path());
    };
    const auto opened = open();
    ASSERT_TRUE(opened) << opened.error().text;
    Probe left = make_probe(model_), right = make_probe(*opened);
    for (const Vec3& query : queries_)
      ASSERT_EQ(bits_of(left.closest_point(query)), bits_of(right.closest_point(query)));
  }
}

#if defined(__SSE2__)
// A trap on an inexact result would end this program.
TEST_F(StabilityHostThread, AnswersIgnoreTrapsOnInexactResults) {
  for (const auto& query_function : query_functions()) {
    const Bits expected = query_function();
    const unsigned before = _mm_getcsr();
    ASSERT_EQ(before & 0x1f80, 0x1f80U);
    Bits found;
    {
      const auto trapping = [&] {
        _mm_setcsr(before & ~0x1fffU);
        found = query_function();
        const unsigned after = _mm_getcsr();
        _mm_setcsr(before);
        return after;
      };
      EXPECT_EQ(trapping(), before & ~0x1fffU);
    }
    EXPECT_EQ(found, expected);
  }
}

TEST_F(StabilityHostThread, ModeIsRestored) {
  const unsigned before = _mm_getcsr();
  for (const unsigned mode : {0x9fc0U, 0x7f80U, 0x1f80U, 0x1fc0U}) {
    _mm_setcsr(mode);
    for (const auto& query_function : query_functions()) {
      query_function();
      EXPECT_EQ(_mm_getcsr() & ~0x3fU, mode);
    }
  }
  _mm_setcsr(before);
}
#endif

}  // namespace
}  // namespace planetree::query
