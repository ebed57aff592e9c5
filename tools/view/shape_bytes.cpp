#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

#include "tools/view/shape_reader.h"

namespace planetree::tools {
namespace {

class Bytes {
 public:
  explicit Bytes(std::size_t size) { text_.reserve(size); }
  template <class T>
  void add(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof value);
    text_.append(bytes, sizeof bytes);
  }
  template <class T, std::size_t kCount>
  void add(const std::array<T, kCount>& values) {
    for (const T value : values) add(value);
  }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// The centre of the disc, halfway between the planes that end it.
std::array<float, 3> middle(const ShapePiece& piece) {
  const float height = 0.5F * (piece.disc.slab_lower + piece.disc.slab_upper);
  std::array<float, 3> centre = piece.box.centre();
  for (std::size_t axis = 0; axis < 3; ++axis) centre[axis] += height * piece.disc.normal[axis];
  return centre;
}

}  // namespace

std::string shape_bytes(const ViewShape& shape) {
  constexpr std::size_t kHeadBytes = 32, kPieceBytes = 64, kTriangleBytes = 48;
  Bytes bytes(kHeadBytes + shape.pieces.size() * kPieceBytes +
              shape.triangles.size() * kTriangleBytes);
  std::uint32_t deepest = 0;
  for (const ShapePiece& piece : shape.pieces)
    deepest = std::max<std::uint32_t>(deepest, piece.depth);
  for (const ShapeTriangle& triangle : shape.triangles)
    deepest = std::max<std::uint32_t>(deepest, triangle.depth);
  bytes.add(std::array<std::uint32_t, 8>{static_cast<std::uint32_t>(shape.pieces.size()),
                                         static_cast<std::uint32_t>(shape.triangles.size()),
                                         shape.is_complete, shape.pages_read, deepest, 0, 0, 0});
  for (const ShapePiece& piece : shape.pieces) {
    bytes.add(middle(piece));
    bytes.add(piece.disc.radius);
    bytes.add(piece.disc.normal);
    bytes.add(static_cast<float>(piece.page));
    bytes.add(piece.box.lower);
    bytes.add(static_cast<float>(piece.depth));
    bytes.add(piece.box.upper);
    bytes.add(static_cast<float>(piece.instance));
  }
  for (const ShapeTriangle& triangle : shape.triangles) {
    const std::array<float, 9>& at = triangle.corners;
    bytes.add(std::array{at[0], at[1], at[2], static_cast<float>(triangle.page), at[3], at[4],
                         at[5], static_cast<float>(triangle.depth), at[6], at[7], at[8],
                         static_cast<float>(triangle.instance)});
  }
  return bytes.take();
}

}  // namespace planetree::tools
