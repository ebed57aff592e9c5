#include "tests/oracle/sheet_models.h"

#include <vector>

namespace planetree::oracle {
namespace {

// Two faces for each cell of a grid. vertex(i, j) is a corner; 0 <= i <= columns, 0 <= j <= rows.
// The front is where (i, j) run counterclockwise.
template <class Vertex, class Omits>
Soup grid(unsigned columns, unsigned rows, const Vertex& vertex, const Omits& omits) {
  Soup faces;
  for (unsigned j = 0; j < rows; ++j)
    for (unsigned i = 0; i < columns; ++i) {
      if (omits(i, j)) continue;
      const Vec3 a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1),
                 d = vertex(i, j + 1);
      faces.push_back({a, b, c});
      faces.push_back({a, c, d});
    }
  return faces;
}

}  // namespace

Soup hills(unsigned steps) {
  Random random(39);
  std::vector<double> bumps((steps + 1) * (steps + 1));
  for (double& bump : bumps) bump = random.unit() * 2.4 / steps;
  const auto vertex = [&](unsigned i, unsigned j) {
    const double x = 2.0 * i / steps - 1, y = 2.0 * j / steps - 1;
    return Vec3{x, y, 0.4 * x * y - 0.3 * x * x * x + bumps[j * (steps + 1) + i]};
  };
  return grid(steps, steps, vertex, [](unsigned, unsigned) { return false; });
}

Soup bowl(unsigned steps) {
  const auto vertex = [steps](unsigned i, unsigned j) {
    const double x = 2.0 * i / steps - 1, y = 2.0 * j / steps - 1;
    return Vec3{x, y, 0.7 * (x * x + y * y)};
  };
  return grid(steps, steps, vertex, [](unsigned, unsigned) { return false; });
}

Soup half_pipe(unsigned steps) {
  const auto vertex = [steps](unsigned i, unsigned j) {
    const auto [x, z] = on_circle(0.5 + 0.5 * i / steps);
    return Vec3{x, 2.0 * j / steps - 1, z};
  };
  return grid(steps, steps, vertex, [](unsigned, unsigned) { return false; });
}

Soup moebius_strip(unsigned steps) {
  constexpr unsigned kRows = 4;
  const auto vertex = [steps](unsigned i, unsigned j) {
    // The last column is the first one upside down, with the same bits.
    const bool is_last = i == steps;
    const double turn = is_last ? 0 : 1.0 * i / steps;
    const double across = 0.6 * (is_last ? kRows - j : j) / kRows - 0.3;
    const auto [x, y] = on_circle(turn);
    const auto [along, up] = on_circle(turn / 2);
    const double radius = 1 + across * along;
    return Vec3{radius * x, radius * y, across * up};
  };
  return grid(steps, kRows, vertex, [](unsigned, unsigned) { return false; });
}

Soup holed_panel(unsigned steps) {
  const auto vertex = [steps](unsigned i, unsigned j) {
    return Vec3{2.0 * i / steps - 1, 2.0 * j / steps - 1, 0};
  };
  return grid(steps, steps, vertex,
              [](unsigned i, unsigned j) { return i % 3 == 1 && j % 3 == 1; });
}

}  // namespace planetree::oracle
