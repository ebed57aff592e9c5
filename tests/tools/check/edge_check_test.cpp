#include "tools/check/edge_check.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

namespace planetree::tools {
namespace {

using octree::Point;

std::vector<octree::Triangle> closed_faces() {
  const Point a(0, 0, 0), b(0, 1, 0), c(1, 0, 0), d(0, 0, 1);
  return {{a, b, c}, {a, d, b}, {b, d, c}, {c, d, a}};
}

bool finds_fault(const storage::ModelRecord& model, const std::vector<octree::Triangle>& faces) {
  EdgeCheck check(model);
  for (const octree::Triangle& face : faces) check.add(face);
  return check.finding().has_value();
}

TEST(EdgeCheck, AcceptsARightHeader) {
  EXPECT_FALSE(finds_fault({}, closed_faces()));
  std::vector<octree::Triangle> twice = closed_faces();
  for (const octree::Triangle& face : closed_faces()) twice.push_back(face);
  EXPECT_FALSE(finds_fault({}, twice));
}

// The edge that the header lists is as stated, and yet no edge is unbalanced.
TEST(EdgeCheck, FindsAWatertightSurfaceDeclaredOpen) {
  storage::ModelRecord model{};
  model.unbalanced_edge_count = 1;
  model.unbalanced_edge[0].to[1] = 1;
  model.unbalanced_edge[0].along = model.unbalanced_edge[0].against = 1;
  EXPECT_TRUE(finds_fault(model, closed_faces()));
}

// A hole, a face with its orientation reversed, a face too many.
TEST(EdgeCheck, FindsAnOpenSurfaceDeclaredWatertight) {
  std::vector<octree::Triangle> faces = closed_faces();
  faces.pop_back();
  EXPECT_TRUE(finds_fault({}, faces));
  faces = closed_faces();
  std::swap(faces[2][0], faces[2][1]);
  EXPECT_TRUE(finds_fault({}, faces));
  faces = closed_faces();
  faces.push_back(faces[0]);
  EXPECT_TRUE(finds_fault({}, faces));
}

}  // namespace
}  // namespace planetree::tools
