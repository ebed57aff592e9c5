#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "octree/builder/mesh/ply_attributes.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/corner_attributes.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_note.h"
#include "octree/builder/mesh/stream/mesh_window.h"
#include "planetree/error.h"

namespace planetree::octree {

/// The attributes of one face of a binary body after the other.
///
/// Those of a long face are read through a window of their own, so that the window of its vertices
/// need not move to and fro.
class PlyFaceBytes {
 public:
  /// All arguments must outlive this.
  PlyFaceBytes(const MeshFile& file, const PlyHeader& header, const PlyAttributes& attributes,
               MeshWindow& window, bool swap)
      : header_(header),
        attributes_(attributes),
        near_(window),
        far_(file, kFarBytes),
        swap_(swap),
        offsets_(attributes.of_faces() ? header.faces().properties.size() : 0) {}

  /// Notes where a property of the face is, and the length of a list.
  void see(std::size_t property, std::uint64_t offset, std::uint64_t count) {
    if (offsets_.empty()) return;
    offsets_[property] = offset;
    if (property == attributes_.face_uvs) uv_count_ = count;
  }
  /// Reads the attributes of the face whose properties were seen.
  ///
  /// corners  of the face.
  /// bytes    of its record.
  Result<void> read(std::uint64_t face, std::uint64_t corners, std::uint64_t bytes) {
    if (offsets_.empty()) return {};
    window_ = bytes <= MeshWindow::kRecordBytes ? &near_ : &far_;
    has_uvs_ = attributes_.face_uvs && uv_count_ % 2 == 0 && uv_count_ / 2 == corners;
    if (attributes_.face_uvs && !has_uvs_) wrong_uvs_.add(face);
    if (attributes_.value) {
      const std::byte* const at = bytes_of(*attributes_.value, 0, 1);
      if (at == nullptr) return window_->failure();
      value_ = load_value(type_of(*attributes_.value), at, swap_);
    }
    return attributes_.face_color.empty() ? Result<void>() : read_color();
  }

  [[nodiscard]] std::uint64_t value() const { return value_; }
  /// Sets the attributes of corner k that the face has; false if they cannot be read.
  bool add_to(std::uint64_t k, CornerAttributes& corner) {
    if (color_) corner.color = *color_;
    if (!has_uvs_) return true;
    const ScalarType type = type_of(*attributes_.face_uvs);
    const std::byte* const at = bytes_of(*attributes_.face_uvs, 2 * k, 2);
    if (at == nullptr) return false;
    corner.uv = {static_cast<float>(load_real(type, at, swap_)),
                 static_cast<float>(load_real(type, at + size_bytes(type), swap_))};
    return true;
  }
  /// The error of add_to().
  [[nodiscard]] const Error& failure() const { return window_->failure(); }
  /// Faces with texture coordinates for another number of corners.
  [[nodiscard]] const RecordNote& wrong_uvs() const { return wrong_uvs_; }

 private:
  static constexpr std::size_t kFarBytes = std::size_t{16} << 10;

  [[nodiscard]] ScalarType type_of(std::size_t property) const {
    return header_.faces().properties[property].type;
  }
  /// Items of a property.
  const std::byte* bytes_of(std::size_t property, std::uint64_t first, std::uint64_t count) {
    const std::uint64_t item_bytes = size_bytes(type_of(property));
    return window_->at(offsets_[property] + first * item_bytes, count * item_bytes);
  }
  Result<void> read_color() {
    std::array<double, 4> numbers = {};
    const std::vector<std::size_t>& properties = attributes_.face_color;
    for (std::size_t i = 0; i < properties.size(); ++i) {
      const std::byte* const at = bytes_of(properties[i], 0, 1);
      if (at == nullptr) return window_->failure();
      numbers[i] = load_real(type_of(properties[i]), at, swap_);
    }
    color_ = color_of(header_.faces(), properties, std::span(numbers).first(properties.size()));
    return {};
  }

  const PlyHeader& header_;
  const PlyAttributes& attributes_;
  MeshWindow& near_;
  MeshWindow far_;
  MeshWindow* window_ = &near_;  ///< that has the face
  const bool swap_;
  std::vector<std::uint64_t> offsets_;  ///< of the properties; empty if no face has attributes
  std::uint64_t uv_count_ = 0;          ///< numbers in the list of texture coordinates
  bool has_uvs_ = false;                ///< the list has two numbers for each corner
  std::optional<Color> color_;
  std::uint64_t value_ = 0;
  RecordNote wrong_uvs_;
};

}  // namespace planetree::octree
