#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "planetree/contact.h"
#include "planetree/model.h"
#include "planetree/probe.h"
#include "tests/query/answer_bits.h"
#include "tests/query/sample_model.h"

/// Comparisons of two files of one model, whose answers must have the same bits, and points to ask.
namespace planetree::query {

/// Points everywhere around the unit sphere. Every second one is at a distance from its centre
/// between `least` and `least` + `range`.
inline std::vector<Vec3> points_around_sphere(std::size_t count, double least, double range) {
  std::vector<Vec3> points = random_queries(count, -1.5, 1.5);
  for (std::size_t i = 0; i < count; i += 2) {
    Vec3& q = points[i];
    const double scale = (least + range * (static_cast<double>(i) / static_cast<double>(count))) /
                         std::sqrt(q.x * q.x + q.y * q.y + q.z * q.z);
    q = {q.x * scale, q.y * scale, q.z * scale};
  }
  return points;
}

/// Compares rays and moving balls from each point to the next, contacts, and tolerant distances.
inline void expect_same_in_each_way(Probe& expected_of, Probe& found_of,
                                    std::span<const Vec3> points) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Vec3 &from = points[i], &to = points[i + 1];
    const Ray ray{from, {to.x - from.x, to.y - from.y, to.z - from.z}};
    ASSERT_EQ(bits_of(found_of.first_hit(ray)), bits_of(expected_of.first_hit(ray)));
    const Sweep sweep{from, to, 0.05};
    ASSERT_EQ(bits_of(found_of.first_contact(sweep)), bits_of(expected_of.first_contact(sweep)));
    std::vector<ClosestPoint> expected(20), found(20);
    const Found contacts = expected_of.contacts(from, 0.3, expected);
    ASSERT_EQ(found_of.contacts(from, 0.3, found).count, contacts.count);
    for (std::size_t k = 0; k < contacts.count; ++k)
      ASSERT_EQ(bits_of(found[k]), bits_of(expected[k]));
    const QueryOptions tolerant{.max_error = 0.02};
    ASSERT_EQ(bits_of(found_of.closest_point(from, tolerant)),
              bits_of(expected_of.closest_point(from, tolerant)));
  }
}

/// Compares the corners of every `step`-th triangle below `count`. Both files keep attributes.
inline void expect_same_triangles(const Model& expected_of, const Model& found_of,
                                  std::uint64_t count, std::uint64_t step) {
  for (std::uint64_t index = 0; index < count; index += step) {
    const auto expected = expected_of.triangle(index), found = found_of.triangle(index);
    ASSERT_TRUE(expected && found);
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3 &a = found->corners[corner], &b = expected->corners[corner];
      ASSERT_TRUE(a.x == b.x && a.y == b.y && a.z == b.z);
    }
  }
}

}  // namespace planetree::query
