#include "octree/page/block_unpacking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "tests/octree/support/each_target.h"

namespace planetree::octree {
namespace {

/// A byte-split array in a buffer of exactly its size, so that a sanitizer reports any read beyond.
template <class T>
class ByteSplitArray {
 public:
  explicit ByteSplitArray(const std::vector<T>& values) : bytes_(sizeof(T) * values.size()) {
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t k = 0; k < sizeof(T); ++k)
        bytes_[k * values.size() + i] = static_cast<std::byte>(values[i] >> 8 * k);
  }
  ByteSplit<T> array() const { return {bytes_.data(), bytes_.size() / sizeof(T)}; }

 private:
  std::vector<std::byte> bytes_;
};

/// Result of unpacking a block's vertex indices or triangle ids.
template <class T>
struct Unpacked {
  std::vector<T> numbers;
  bool good = false;
};

using VertexIndices = Unpacked<std::uint16_t>;

VertexIndices unpack(const std::vector<std::uint16_t>& refs, const BlockVertices& block,
                     unsigned stride) {
  const ByteSplitArray<std::uint16_t> stored(refs);
  VertexIndices indices{std::vector<std::uint16_t>(stride), false};
  indices.good = unpack_indices(stored.array(), block, stride, indices.numbers.data());
  return indices;
}

class VertexIndicesTest : public testing::Test {
 protected:
  // Places the refs of a block after up to 2 refs of other blocks and before `behind` refs of other
  // blocks.
  void put_refs(unsigned count, std::size_t behind) {
    block_.first_ref = random_() % 3;
    block_.ref_count = count;
    refs_.assign(block_.first_ref + count + behind, 0xffff);
    std::size_t index = 0;
    for (unsigned i = 0; i < count; ++i) {
      const std::size_t step = random_() % 900 + (i > 0 ? 1 : 0);
      refs_[block_.first_ref + i] = static_cast<std::uint16_t>(step);
      index += step;
    }
    block_.first_new = count > 0 ? index + 1 : 7;
  }
  std::uint16_t& ref(unsigned i) { return refs_[block_.first_ref + i]; }

  void expect_all(bool good, unsigned stride) {
    for (const VertexIndices& one : on_each_target([&] { return unpack(refs_, block_, stride); }))
      ASSERT_EQ(one.good, good) << block_.ref_count << " of " << stride;
  }

  std::mt19937_64 random_{1};
  std::vector<std::uint16_t> refs_;
  BlockVertices block_{};
};

TEST_F(VertexIndicesTest, ListRefsThenNewVerticesThenRepeatTheFirst) {
  for (const unsigned stride : {16U, 24U, 32U, 48U})
    for (unsigned refs = 0; refs <= stride; ++refs)
      for (const std::size_t behind : {0, 60}) {
        put_refs(refs, behind);
        block_.vertex_count =
            std::max(1U, refs + static_cast<unsigned>(random_() % (stride - refs + 1)));
        std::vector<std::uint16_t> expected;
        std::size_t index = 0;
        for (unsigned i = 0; i < refs; ++i)
          expected.push_back(static_cast<std::uint16_t>(index += ref(i)));
        for (std::size_t vertex = block_.first_new; expected.size() < block_.vertex_count;)
          expected.push_back(static_cast<std::uint16_t>(vertex++));
        expected.resize(stride, expected[0]);
        for (const VertexIndices& one :
             on_each_target([&] { return unpack(refs_, block_, stride); })) {
          EXPECT_TRUE(one.good);
          ASSERT_EQ(one.numbers, expected) << refs << " of " << stride;
        }
      }
}

TEST_F(VertexIndicesTest, RefuseRepeatedAndForwardRefs) {
  for (const unsigned stride : {16U, 48U})
    for (unsigned refs = 1; refs <= stride; ++refs)
      for (const std::size_t behind : {0, 60}) {
        block_.vertex_count = refs;
        put_refs(refs, behind);
        expect_all(true, stride);
        --block_.first_new;
        expect_all(false, stride);
        ++block_.first_new;
        if (refs == 1) continue;
        // Repeats any ref but the first, then makes the sum of steps exceed 16 bits: it must not
        // wrap round to a valid index.
        const unsigned i = 1 + static_cast<unsigned>(random_() % (refs - 1));
        const std::uint16_t step = ref(i);
        block_.first_new -= step;
        ref(i) = 0;
        expect_all(false, stride);
        block_.first_new = 0xffff;
        ref(i) = 0xffff;
        expect_all(false, stride);
      }
}

TEST_F(VertexIndicesTest, AcceptFirstAndLastVertexOfThePage) {
  put_refs(2, 0);
  ref(0) = 0, ref(1) = 0xfffe;
  block_.first_new = block_.vertex_count = 2;
  expect_all(false, 16);
  block_.first_new = 0xffff;
  expect_all(true, 16);
}

template <class Id>
class UnpackIdsTest : public testing::Test {
 protected:
  using Ids = Unpacked<Id>;

  // Places `count` - 1 random steps after `before` steps and before `behind` steps of other blocks.
  void put_steps(std::size_t before, unsigned count, std::size_t behind) {
    first_step_ = before;
    count_ = count;
    steps_.assign(before + count - 1 + behind, 0);
    for (unsigned i = 0; i + 1 < count; ++i) step(i) = static_cast<Id>(1 + random_() % 100'000);
  }
  Id& step(unsigned i) { return steps_[first_step_ + i]; }

  std::vector<Ids> unpack(Id first) const {
    return on_each_target([&] {
      const ByteSplitArray<Id> stored(steps_);
      Ids ids{std::vector<Id>(kMaxBlockTriangles), false};
      ids.good = unpack_ids(first, stored.array(), first_step_, count_, ids.numbers.data());
      return ids;
    });
  }

  std::mt19937_64 random_{2};
  std::vector<Id> steps_;
  std::size_t first_step_ = 0;
  unsigned count_ = 1;
};

using IdTypes = testing::Types<std::uint32_t, std::uint64_t>;
TYPED_TEST_SUITE(UnpackIdsTest, IdTypes);

TYPED_TEST(UnpackIdsTest, SumsStepsAndRepeatsTheLastId) {
  for (unsigned count = 1; count <= kMaxBlockTriangles; ++count)
    for (const std::size_t before : {0, 1, 9})
      for (const std::size_t behind : {0, 1, 15, 40}) {
        this->put_steps(before, count, behind);
        std::vector<TypeParam> expected{123'456};
        for (unsigned i = 0; i + 1 < count; ++i) expected.push_back(expected[i] + this->step(i));
        expected.resize(kMaxBlockTriangles, expected.back());
        for (const auto& one : this->unpack(123'456)) {
          EXPECT_TRUE(one.good);
          ASSERT_EQ(one.numbers, expected) << count;
        }
      }
}

TYPED_TEST(UnpackIdsTest, RefusesIdsThatDoNotAscend) {
  constexpr auto kMax = std::numeric_limits<TypeParam>::max();
  for (unsigned count = 2; count <= kMaxBlockTriangles; ++count)
    for (unsigned i = 0; i + 1 < count; ++i)
      for (const std::size_t behind : {0, 40}) {
        this->put_steps(1, count, behind);
        TypeParam sum = 0;
        for (unsigned k = 0; k + 1 < count; ++k) sum += this->step(k);
        for (const auto& one : this->unpack(kMax - sum)) ASSERT_TRUE(one.good);
        for (const auto& one : this->unpack(kMax - sum + 1)) ASSERT_FALSE(one.good);
        this->step(i) = 0;
        for (const auto& one : this->unpack(1)) ASSERT_FALSE(one.good) << i << " of " << count;
      }
}

}  // namespace
}  // namespace planetree::octree
