// Holds the answers of `planetree query` against every triangle of the mesh.
// usage: check_answers MESH ANSWERS.csv [COUNT]
// Checks the first COUNT answers (default: all). Exit status 1 if any is wrong.

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "octree/build/mesh_reader.h"
#include "tests/oracle/brute_force.h"
#include "tests/oracle/winding.h"

namespace planetree::oracle {
namespace {

class MeshTriangles final : public octree::TriangleSink {
 public:
  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
    indices.push_back(index);
    triangles.push_back(corners);
    return {};
  }
  void set_aside(std::uint64_t, std::uint64_t, const octree::SetAside&) override {}
  void progress(std::uint64_t, std::uint64_t) override {}

  std::vector<std::uint64_t> indices;
  std::vector<Corners> triangles;
};

struct Answer {
  Vec3 query;
  double distance, lower, upper;
  std::string side;
  std::uint64_t triangle;
};

// x,y,z,distance,lower,upper,side,px,py,pz,nx,ny,nz,triangle,...
Answer parse(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) fields.push_back(field);
  if (fields.size() < 14) return {};
  const auto number = [&](std::size_t i) { return std::strtod(fields[i].c_str(), nullptr); };
  return {{number(0), number(1), number(2)},
          number(3),
          number(4),
          number(5),
          fields[6],
          std::strtoull(fields[13].c_str(), nullptr, 10)};
}

double gap(double a, double b, double c, double at) {
  const double lower = std::fmin(std::fmin(a, b), c);
  const double upper = std::fmax(std::fmax(a, b), c);
  return at < lower ? lower - at : at > upper ? at - upper : 0;
}

// A triangle farther than this by its box alone need not be measured.
double distance_to_box(const Corners& t, const Vec3& q) {
  const double x = gap(t[0].x, t[1].x, t[2].x, q.x);
  const double y = gap(t[0].y, t[1].y, t[2].y, q.y);
  const double z = gap(t[0].z, t[1].z, t[2].z, q.z);
  return std::sqrt(x * x + y * y + z * z) * (1 - 1e-12);
}

// The nearest distance of all triangles, and that of the one answered.
bool right(const MeshTriangles& mesh, const Answer& answer) {
  long double nearest = std::numeric_limits<long double>::infinity();
  long double answered = nearest;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const bool named = mesh.indices[i] == answer.triangle;
    if (!named && distance_to_box(mesh.triangles[i], answer.query) >= nearest) continue;
    const long double distance = extended_distance(answer.query, mesh.triangles[i]);
    nearest = std::fmin(nearest, distance);
    if (named) answered = distance;
  }
  const long double width = static_cast<long double>(answer.upper) - answer.lower;
  return answer.lower <= nearest && nearest <= answer.upper && answered - nearest <= width;
}

// The side by the sum of all solid angles; of every tenth answer, for it takes
// its time. Those on the surface, or too near it for the sum, pass.
bool side_is_right(const MeshTriangles& mesh, const Answer& answer) {
  const long double winding = solid_angle_winding(answer.query, mesh.triangles);
  const long double whole = std::round(winding);
  if (std::fabs(winding - whole) > 1e-6L) return true;
  return answer.side == (whole != 0 ? "inside" : "outside");
}

int run(const char* mesh_path, const char* answers_path, std::size_t count) {
  MeshTriangles mesh;
  if (const auto read = octree::read_mesh(mesh_path, mesh); !read) {
    std::cerr << "check_answers: " << read.error().text << '\n';
    return 1;
  }
  std::ifstream answers(answers_path);
  std::string line;
  std::getline(answers, line);  // the header
  std::size_t checked = 0, wrong = 0;
  for (; checked < count && std::getline(answers, line); ++checked)
    if (const Answer answer = parse(line);
        !right(mesh, answer) || (checked % 10 == 0 && !side_is_right(mesh, answer))) {
      ++wrong;
      std::cout << "wrong: " << line << '\n';
    }
  std::printf("%zu answers held against all %zu triangles: %zu wrong\n", checked,
              mesh.triangles.size(), wrong);
  return wrong == 0 && checked > 0 ? 0 : 1;
}

}  // namespace
}  // namespace planetree::oracle

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: check_answers MESH ANSWERS.csv [COUNT]\n";
    return 2;
  }
  const std::size_t count = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : ~std::size_t{0};
  return planetree::oracle::run(argv[1], argv[2], count);
}
