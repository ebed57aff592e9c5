#include "tools/view/shape_reader.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

constexpr std::chrono::milliseconds kLong{60000};

/// A bumpy square of kTriangles triangles, kSide long.
class ShapeReaderTest : public Command {
 protected:
  void SetUp() override {
    Command::SetUp();
    auto reader = ShapeReader::open("tree.ptree");
    ASSERT_TRUE(reader) << reader.error().text;
    reader_.emplace(std::move(*reader));
  }
  const ViewShape& read(const ShapeView& view) {
    const auto shape = reader_->read(view, kLong);
    EXPECT_TRUE(shape) << shape.error().text;
    return **shape;
  }
  static ShapeView of(std::uint32_t discs) {
    ShapeView view;
    view.discs = discs;
    return view;
  }

  std::optional<ShapeReader> reader_;
};

TEST_F(ShapeReaderTest, EndsWithAllTriangles) {
  const ViewShape& shape = read(of(ShapeView::kMaxDiscs));
  EXPECT_TRUE(shape.is_complete);
  EXPECT_TRUE(shape.pieces.empty());
  ASSERT_EQ(shape.triangles.size(), kTriangles);
  double area = 0;  // of the square below, by two of three coordinates
  for (const ShapeTriangle& triangle : shape.triangles) {
    const auto& at = triangle.corners;
    area += 0.5 * std::fabs(double{at[3] - at[0]} * double{at[7] - at[1]} -
                            double{at[6] - at[0]} * double{at[4] - at[1]});
  }
  // The longest edge is scaled to [1, 2): 14 * 2^-3.
  EXPECT_NEAR(area, 1.75 * 1.75, 1e-5);
}

TEST_F(ShapeReaderTest, KeepsToItsLimit) {
  std::size_t before = 0;
  for (const std::uint32_t limit : {1U, 10U, 30U, 100U, 200U}) {
    const ViewShape& shape = read(of(limit));
    EXPECT_TRUE(shape.is_complete);
    EXPECT_LE(shape.size(), std::max<std::size_t>(limit, octree::kFanOut)) << limit;
    EXPECT_GE(shape.size(), before);
    before = shape.size();
  }
  EXPECT_GT(before, 100u);
}

TEST_F(ShapeReaderTest, CoversTheSurfaceByDiscs) {
  const ViewShape pieces = read(of(30));
  const ViewShape& whole = read(of(ShapeView::kMaxDiscs));
  ASSERT_FALSE(pieces.pieces.empty());
  for (const ShapeTriangle& triangle : whole.triangles) {
    const auto& at = triangle.corners;
    const auto holds = [&](const ShapePiece& piece) {
      for (std::size_t corner = 0; corner < 9; corner += 3)
        for (std::size_t axis = 0; axis < 3; ++axis)
          if (at[corner + axis] < piece.box.lower[axis] - 1e-6F ||
              at[corner + axis] > piece.box.upper[axis] + 1e-6F)
            return false;
      return true;
    };
    const bool is_in_piece = std::any_of(pieces.pieces.begin(), pieces.pieces.end(), holds);
    const bool is_in_shape =
        std::any_of(pieces.triangles.begin(), pieces.triangles.end(),
                    [&](const ShapeTriangle& other) { return other.corners == at; });
    EXPECT_TRUE(is_in_piece || is_in_shape);
  }
}

TEST_F(ShapeReaderTest, IsFinerNearTheEye) {
  ShapeView view = of(120);
  view.has_eye = true;
  view.eye = {-0.875, -0.875, 0.1};  // above a corner of the square
  view.look = {0, 0, -1};
  const ViewShape& shape = read(view);
  ASSERT_FALSE(shape.triangles.empty());
  double near = 0, far = 0;
  for (const ShapeTriangle& triangle : shape.triangles)
    (triangle.corners[0] + triangle.corners[1] < 0 ? near : far) += 1;
  EXPECT_GT(near, 3 * far);
}

TEST_F(ShapeReaderTest, GoesOnWhereItStoppedForLackOfTime) {
  const auto first = reader_->read(of(1000), std::chrono::milliseconds(0));
  ASSERT_TRUE(first);
  EXPECT_FALSE((*first)->is_complete);
  EXPECT_TRUE(read(of(1000)).is_complete);
}

TEST_F(ShapeReaderTest, SaysWhichPageIsDamaged) {
  flip("tree.ptree", entries_[1].offset + 5);
  const auto shape = reader_->read(of(ShapeView::kMaxDiscs), kLong);
  ASSERT_FALSE(shape);
  EXPECT_EQ(shape.error().code, ErrorCode::kDamaged);
  EXPECT_EQ(shape.error().page, 1u);
}

TEST_F(ShapeReaderTest, WritesDiscsAndTriangles) {
  const ViewShape& shape = read(of(60));
  const std::string bytes = shape_bytes(shape);
  ASSERT_EQ(bytes.size(), 32 + 64 * shape.pieces.size() + 48 * shape.triangles.size());
  std::uint32_t head[5];
  std::memcpy(head, bytes.data(), sizeof head);
  EXPECT_EQ(head[0], shape.pieces.size());
  EXPECT_EQ(head[1], shape.triangles.size());
  EXPECT_EQ(head[2], 1u);
  EXPECT_EQ(head[3], shape.pages_read);
  float disc[16];
  std::memcpy(disc, bytes.data() + 32, sizeof disc);
  EXPECT_EQ(disc[3], shape.pieces[0].disc.radius);
  EXPECT_EQ(disc[6], shape.pieces[0].disc.normal[2]);
  EXPECT_EQ(disc[7], static_cast<float>(shape.pieces[0].page));
  EXPECT_EQ(disc[12], shape.pieces[0].box.upper[0]);
}

}  // namespace
}  // namespace planetree::tools
