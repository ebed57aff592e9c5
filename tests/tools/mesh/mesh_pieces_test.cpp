#include "tools/mesh/mesh_pieces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace planetree::tools {
namespace {

using Corners = std::array<Vec3, 3>;

double area_of(const MeshPiece& piece) {
  double sum = 0;
  for (const auto& [a, b, c] : piece.triangles) {
    const Vec3 &p = piece.corners[a], &q = piece.corners[b], &r = piece.corners[c];
    sum += std::fabs((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x)) / 2;
  }
  return sum;
}

TEST(MeshPieces, NumberAPositionOnce) {
  std::vector<MeshPiece> pieces;
  MeshPieceMaker maker({}, [&](const MeshPiece& piece) {
    pieces.push_back(piece);
    return Result<void>();
  });
  EXPECT_TRUE(maker.add({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{1, 1, 0}}));
  EXPECT_TRUE(maker.add({Vec3{0, 0, 0}, Vec3{1, 1, 0}, Vec3{0, 1, 0}}));
  EXPECT_TRUE(maker.finish());
  ASSERT_EQ(pieces.size(), 1u);
  EXPECT_EQ(pieces[0].corners.size(), 4u);
  EXPECT_EQ(pieces[0].triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
  EXPECT_EQ(pieces[0].triangles[1], (std::array<std::uint32_t, 3>{0, 2, 3}));
}

TEST(MeshPieces, CutLongTrianglesWithoutGapsOrTurns) {
  MeshPiece all;
  MeshPieceMaker maker({0.25}, [&](const MeshPiece& piece) {
    all = piece;
    return Result<void>();
  });
  EXPECT_TRUE(maker.add({Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0.5, 1, 0}}));
  EXPECT_TRUE(maker.finish());
  EXPECT_NEAR(area_of(all), 2, 1e-12);
  for (const auto& [a, b, c] : all.triangles) {
    const Vec3 &p = all.corners[a], &q = all.corners[b], &r = all.corners[c];
    EXPECT_GT((q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x), 0) << "turned over";
    EXPECT_LE(std::max({distance_of(p, q), distance_of(q, r), distance_of(r, p)}), 0.25);
  }
  EXPECT_LT(all.corners.size(), all.triangles.size()) << "parts share corners";
}

TEST(MeshPieces, CutsHaveALimit) {
  std::size_t triangles = 0;
  MeshPieceMaker maker({1e-9}, [&](const MeshPiece& piece) {
    EXPECT_LE(piece.triangles.size(), MeshPieceMaker::kTriangles);
    triangles += piece.triangles.size();
    return Result<void>();
  });
  EXPECT_TRUE(maker.add({Vec3{0, 0, 0}, Vec3{4, 0, 0}, Vec3{0.5, 1, 0}}));
  EXPECT_TRUE(maker.finish());
  EXPECT_EQ(triangles, std::size_t{1} << MeshPieceMaker::kMaxCuts);
}

TEST(MeshPieces, AreModestInNumberUnlessToldOtherwise) {
  for (const std::uint64_t triangles : {1U, 12U, 1000U, 100000U, 3000000U, 90000000U}) {
    const int most = MeshPieceMaker::modest_cuts(0.1, triangles).most;
    EXPECT_LE(most, MeshPieceMaker::kMaxCuts);
    EXPECT_LE(triangles << most, std::max<std::uint64_t>(triangles, 1U << 22)) << triangles;
    EXPECT_TRUE(most == MeshPieceMaker::kMaxCuts || triangles << (most + 1) > 1U << 22);
  }
  EXPECT_GT(MeshPieceMaker::modest_cuts(0.1, 0).most, 0);
}

TEST(MeshPieces, PassOnErrors) {
  MeshPieceMaker maker({1}, [](const MeshPiece&) -> Result<void> {
    return make_error(ErrorCode::kNoSpace, Error::kNowhere, Error::kNowhere, "full");
  });
  EXPECT_TRUE(maker.add({Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0, 1, 0}}));
  const auto finished = maker.finish();
  ASSERT_FALSE(finished);
  EXPECT_EQ(finished.error().code, ErrorCode::kNoSpace);
}

}  // namespace
}  // namespace planetree::tools
