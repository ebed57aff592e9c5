#include "tools/check/edge_check.h"

#include <gtest/gtest.h>

#include <algorithm>
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
  for (std::size_t i = 0; i < faces.size(); ++i) check.add(faces[i], i);
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

/// Three faces of a closed surface, and a header that lists the edges that the fourth would have.
storage::ModelRecord model_of_hole() {
  storage::ModelRecord model{};
  model.triangle_count = 3;
  model.unbalanced_edge_count = 3;
  const double from[3][3] = {{1, 0, 0}, {0, 0, 1}, {0, 0, 0}};
  const double to[3][3] = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
  const std::uint64_t triangle[3] = {0, 2, 1};
  const unsigned order[3] = {0, 2, 1};
  for (unsigned i = 0; i < 3; ++i) {
    storage::UnbalancedEdge& edge = model.unbalanced_edge[i];
    std::copy_n(from[order[i]], 3, edge.from);
    std::copy_n(to[order[i]], 3, edge.to);
    edge.triangle = triangle[order[i]];
    edge.along = 1;
  }
  return model;
}

TEST(EdgeCheck, AcceptsTheEdgesOfAHole) {
  std::vector<octree::Triangle> faces = closed_faces();
  faces.pop_back();
  EXPECT_FALSE(finds_fault(model_of_hole(), faces));
}

TEST(EdgeCheck, FindsAWrongListOfEdges) {
  std::vector<octree::Triangle> faces = closed_faces();
  faces.pop_back();
  storage::ModelRecord model = model_of_hole();
  std::swap(model.unbalanced_edge[0], model.unbalanced_edge[1]);
  EXPECT_TRUE(finds_fault(model, faces));
  model = model_of_hole();
  model.unbalanced_edge[2].triangle = 1;
  EXPECT_TRUE(finds_fault(model, faces));
  model = model_of_hole();
  std::swap(model.unbalanced_edge[0].from, model.unbalanced_edge[0].to);
  std::swap(model.unbalanced_edge[0].along, model.unbalanced_edge[0].against);
  EXPECT_TRUE(finds_fault(model, faces));
  model = model_of_hole();
  model.unbalanced_edge_count = 4;
  EXPECT_TRUE(finds_fault(model, faces));
  model = model_of_hole();
  model.unbalanced_edge_count = 2;
  model.unbalanced_edge[2] = {};
  EXPECT_TRUE(finds_fault(model, faces));
}

}  // namespace
}  // namespace planetree::tools
