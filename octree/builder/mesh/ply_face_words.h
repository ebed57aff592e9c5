#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "octree/builder/mesh/ply_attributes.h"
#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/ply_words.h"
#include "octree/builder/mesh/stream/indexed_face.h"
#include "octree/builder/mesh/stream/mesh_note.h"

namespace planetree::octree {

/// The attributes of one face of an ascii body after the other.
class PlyFaceWords {
 public:
  /// Both arguments must outlive this.
  PlyFaceWords(const PlyHeader& header, const PlyAttributes& attributes)
      : header_(header), attributes_(attributes), is_needed_(attributes.of_faces()) {}

  /// Takes a property other than the list of vertices from the words of a face. False at an error
  /// of the words.
  bool take(std::size_t property, PlyWords& words) {
    const PlyProperty& declared = header_.faces().properties[property];
    if (!is_needed_) return words.pass(declared);
    if (property == attributes_.face_uvs) return take_uvs(declared, words);
    const auto& color = attributes_.face_color;
    const auto channel = std::find(color.begin(), color.end(), property) - color.begin();
    double* const number =
        channel < std::ssize(color) ? &channels_[static_cast<std::size_t>(channel)] : nullptr;
    if (property == attributes_.value) {
      if (!words.value(declared, value_)) return false;
      if (number != nullptr) *number = real_value(value_, attributes_.value_kind);
      return true;
    }
    return number == nullptr ? words.pass(declared) : words.number(declared, *number);
  }

  /// The attributes of a face whose properties were taken, valid until the next face; null if no
  /// face has any.
  const FaceAttributes* finish(std::uint64_t face, std::uint64_t corners) {
    if (!is_needed_) return nullptr;
    const auto& color = attributes_.face_color;
    if (!color.empty())
      made_.color = color_of(header_.faces(), color, std::span(channels_).first(color.size()));
    const bool has_uvs = uv_count_ % 2 == 0 && uv_count_ / 2 == corners;
    made_.uvs =
        has_uvs ? std::span<const TextureCoordinate>(uvs_) : std::span<const TextureCoordinate>();
    if (attributes_.face_uvs && !has_uvs) wrong_uvs_.add(face);
    return &made_;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }
  /// Faces with texture coordinates for another number of corners.
  [[nodiscard]] const RecordNote& wrong_uvs() const { return wrong_uvs_; }

 private:
  bool take_uvs(const PlyProperty& list, PlyWords& words) {
    std::int64_t count = 0;
    if (!words.length(list, count)) return false;
    uv_count_ = static_cast<std::uint64_t>(count);
    uvs_.clear();
    for (std::int64_t i = 0; i < count; ++i) {
      double number = 0;
      if (!words.number(list, number)) return false;
      if (i % 2 == 0) uvs_.emplace_back();
      (i % 2 == 0 ? uvs_.back().u : uvs_.back().v) = static_cast<float>(number);
    }
    return true;
  }

  const PlyHeader& header_;
  const PlyAttributes& attributes_;
  const bool is_needed_;
  std::array<double, 4> channels_ = {};
  std::vector<TextureCoordinate> uvs_;
  std::uint64_t uv_count_ = 0;  ///< numbers in the list of texture coordinates
  std::uint64_t value_ = 0;
  FaceAttributes made_;
  RecordNote wrong_uvs_;
};

}  // namespace planetree::octree
