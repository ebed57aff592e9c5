#include "octree/exact_predicates.h"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>

#include "octree/double_parts.h"

namespace planetree::octree {
namespace {

namespace mp = boost::multiprecision;

/// Coordinates are whole multiples of 2^-1074 below 2^302, differences of two
/// below 2^1377, and a determinant is a sum of six products of three: below
/// 2^4134. The room is on the stack.
using Whole = mp::number<mp::cpp_int_backend<4160, 4160, mp::signed_magnitude, mp::unchecked, void>,
                         mp::et_off>;
using Vector = std::array<Whole, 3>;

/// Numbers that are multiples of one power of two, as small as it can be chosen.
class CommonUnit {
 public:
  template <std::size_t kCount>
  explicit CommonUnit(const std::array<const Point*, kCount>& points) {
    for (const Point* point : points)
      for (const double value : *point)
        if (const DoubleParts parts(value); parts.mantissa != 0)
          exponent_ = std::min(exponent_, parts.exponent);
  }

  Vector difference(const Point& to, const Point& from) const {
    Vector result;
    for (unsigned axis = 0; axis < 3; ++axis) result[axis] = whole(to[axis]) - whole(from[axis]);
    return result;
  }

 private:
  Whole whole(double value) const {
    const DoubleParts parts(value);
    Whole result = parts.mantissa;
    if (parts.mantissa != 0) result <<= static_cast<unsigned>(parts.exponent - exponent_);
    return result;
  }

  int exponent_ = 2046;
};

}  // namespace

int exact_orientation(const Point& a, const Point& b, const Point& c, const Point& d) noexcept {
  const CommonUnit unit(std::array{&a, &b, &c, &d});
  const Vector u = unit.difference(b, a), v = unit.difference(c, a), w = unit.difference(d, a);
  const Whole volume = u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) +
                       u[2] * (v[0] * w[1] - v[1] * w[0]);
  return volume.sign();
}

int exact_normal_sign(const Point& a, const Point& b, const Point& c, unsigned axis) noexcept {
  const CommonUnit unit(std::array{&a, &b, &c});
  const Vector u = unit.difference(b, a), v = unit.difference(c, a);
  const unsigned i = (axis + 1) % 3, j = (axis + 2) % 3;
  const Whole area = u[i] * v[j] - u[j] * v[i];
  return area.sign();
}

}  // namespace planetree::octree
