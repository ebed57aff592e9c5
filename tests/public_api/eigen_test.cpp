#include <planetree/eigen.h>

#include "tests/public_api/meshes.h"

namespace planetree::public_api {
namespace {

TEST(EigenConversions, KeepCoordinates) {
  const Vec3 v{1, -2, 0x1p-60};
  EXPECT_EQ(to_eigen(v), Eigen::Vector3d(1, -2, 0x1p-60));
  const Vec3 back = to_vec3(to_eigen(v));
  EXPECT_TRUE(back.x == v.x && back.y == v.y && back.z == v.z);
  const Vec3 of_floats = to_vec3(Eigen::RowVector3f(0.5f, 2, 3));
  EXPECT_TRUE(of_floats.x == 0.5 && of_floats.y == 2 && of_floats.z == 3);
  EXPECT_EQ(to_vec3(to_eigen(v) * 2).y, -4) << "an expression";
}

TEST(EigenConversions, ShowPointsAsColumnsWithoutACopy) {
  const std::vector<Vec3> points = {{1, 2, 3}, {4, 5, 6}};
  const auto columns = columns_of(points);
  EXPECT_EQ(columns.data(), &points[0].x);
  EXPECT_EQ(columns.cols(), 2);
  EXPECT_EQ(columns(1, 1), 5);
  const std::vector<Vec3> back = points_of_columns(columns);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[1].z, 6);
}

TEST(EigenConversions, TakeMeshesByRows) {
  Eigen::Matrix<float, 3, 3, Eigen::RowMajor> vertices;
  vertices << 0, 0, 0, 1, 0, 0, 0, 1, 0.5f;
  const std::vector<Vec3> points = points_of_rows(vertices);
  ASSERT_EQ(points.size(), 3u);
  EXPECT_TRUE(points[2].x == 0 && points[2].y == 1 && points[2].z == 0.5);

  Eigen::Matrix<std::int64_t, Eigen::Dynamic, 3> faces(3, 3);
  faces << 0, 1, 2, 2, -1, 0, 0, std::int64_t{1} << 40, 1;
  const std::vector<TriangleVertices> triangles = triangles_of_rows(faces);
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  EXPECT_EQ(triangles, (std::vector<TriangleVertices>{{0, 1, 2}, {2, kNone, 0}, {0, kNone, 1}}));
}

class EigenMesh : public InFolder {};

TEST_F(EigenMesh, IsBuilt) {
  const Mesh mesh = torus(20, 10);
  Eigen::MatrixXd vertices = columns_of(mesh.vertices).transpose();
  Eigen::MatrixXi faces(static_cast<Eigen::Index>(mesh.triangles.size()), 3);
  for (Eigen::Index i = 0; i < faces.rows(); ++i)
    for (Eigen::Index k = 0; k < 3; ++k)
      faces(i, k) = static_cast<int>(
          mesh.triangles[static_cast<std::size_t>(i)][static_cast<std::size_t>(k)]);
  const auto points = points_of_rows(vertices);
  const auto triangles = triangles_of_rows(faces);
  EXPECT_EQ(built({points, triangles}), built(mesh.input()));
}

}  // namespace
}  // namespace planetree::public_api
