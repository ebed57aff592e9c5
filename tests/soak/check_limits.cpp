// Compares answers of limited work, and answers without waiting, with those of blocking queries.
// usage: check_limits MESH MODEL.ptree [QUERIES]
//
// MODEL.ptree was built from MESH. Makes QUERIES queries, a million by default: anywhere in the
// box, near the surface, on faces, edges and corners and an ulp beside them, on the caps of a
// surface with holes, and beside the last query. Exit status 1 if any answer is wrong.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <vector>

#include "tests/oracle/limited_queries.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/random.h"
#include "tests/soak/mesh_triangles.h"

namespace planetree::oracle {
namespace {

// A point on a triangle: exactly, if its coordinates have few bits. Sometimes an ulp beside it.
Vec3 at_triangle(Random& random, const Corners& triangle) {
  constexpr double kShares[] = {0, 0.25, 0.5, 0.75};
  const double u = kShares[random.below(4)], v = (1 - u) * kShares[random.below(4)];
  const std::uint64_t aside = random.below(6);  // an axis, or nowhere
  const auto mix = [&](unsigned axis, double a, double b, double c) {
    const double value = (1 - u - v) * a + u * b + v * c;
    return axis == aside ? std::nextafter(value, std::numeric_limits<double>::infinity()) : value;
  };
  const auto& [a, b, c] = triangle;
  return {mix(0, a.x, b.x, c.x), mix(1, a.y, b.y, c.y), mix(2, a.z, b.z, c.z)};
}

class Places {
 public:
  Places(std::vector<Corners> triangles, std::vector<Corners> caps)
      : triangles_(std::move(triangles)), caps_(std::move(caps)) {
    for (const Corners& triangle : triangles_)
      for (const Vec3& corner : triangle)
        size_ = std::max({size_, std::fabs(corner.x - triangles_[0][0].x),
                          std::fabs(corner.y - triangles_[0][0].y),
                          std::fabs(corner.z - triangles_[0][0].z)});
  }

  Vec3 any(Random& random) {
    switch (random.below(6)) {
      case 0:
        return last_ = nasty_query(random, triangles_, size_);
      case 1:
        return last_ = triangles_[random.below(triangles_.size())][0] + random.in_cube() * size_;
      case 2:
        return last_ = last_ + random.in_some_cube(-30, -8) * size_;
      case 3:
        if (!caps_.empty()) return last_ = at_triangle(random, caps_[random.below(caps_.size())]);
        [[fallthrough]];
      default:
        return last_ = at_triangle(random, triangles_[random.below(triangles_.size())]);
    }
  }

 private:
  const std::vector<Corners> triangles_, caps_;
  double size_ = 0;
  Vec3 last_;
};

int run(const char* mesh, const char* file, std::size_t queries) {
  constexpr std::size_t kShown = 10;
  LimitedQueries limited(file);
  std::vector<Corners> caps = limited.caps();
  const std::size_t cap_count = caps.size();
  Places places(triangles_of(mesh), std::move(caps));
  Random random(3);
  std::size_t wrong = 0;
  for (std::size_t i = 0; i < queries; ++i)
    if (!limited.agree(places.any(random), random) && ++wrong <= kShown)
      std::printf("%s\n", limited.last_miss().c_str());
  std::printf("%zu limited queries, %zu exact; %zu caps; %zu wrong\n", queries, limited.exact(),
              cap_count, wrong);
  return wrong > 0 ? 1 : 0;
}

}  // namespace
}  // namespace planetree::oracle

int main(int argc, char** argv) {
  if (argc < 3 || argc > 4) {
    std::fprintf(stderr, "usage: check_limits MESH MODEL.ptree [QUERIES]\n");
    return 2;
  }
  return planetree::oracle::run(argv[1], argv[2],
                                argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 1000000);
}
