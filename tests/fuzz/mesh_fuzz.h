#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>

#include "octree/builder/mesh/mesh_reader.h"
#include "octree/builder/mesh/stream/corner_attributes.h"
#include "tests/fuzz/memory_file.h"

/// Parts that the fuzzers of mesh readers share.
namespace planetree::octree {

/// A hash of all bytes added, in order (FNV-1a).
class Digest {
 public:
  void add(const void* bytes, std::size_t size) {
    const auto* const at = static_cast<const unsigned char*>(bytes);
    for (std::size_t i = 0; i < size; ++i) value_ = (value_ ^ at[i]) * 0x100000001b3;
  }
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// Aborts where a reader violates the contract of TriangleSink.
class CheckingSink : public TriangleSink {
 public:
  Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
    expect(index == next_index_);
    ++next_index_;
    ++triangle_count_;
    digest_.add(corners.data(), sizeof corners);
    for (const Vec3& corner : corners) {
      for (const double value : {corner.x, corner.y, corner.z}) {
        expect(std::isfinite(value) && !(value == 0 && std::signbit(value)));
        float32_ &= value == static_cast<double>(static_cast<float>(value));
      }
    }
    return {};
  }

  Result<void> attributes(const TriangleAttributes& attributes) override {
    ++attribute_count_;
    expect(attribute_count_ == triangle_count_);
    digest_.add(attributes.colors.data(), sizeof attributes.colors);
    digest_.add(&attributes.value, sizeof attributes.value);
    // A NaN has several forms.
    for (const TextureCoordinate& uv : attributes.uvs)
      for (const float value : {uv.u, uv.v})
        if (value == value) digest_.add(&value, sizeof value);
    return {};
  }

  void skipped(std::uint64_t first_index, std::uint64_t count, const SkippedRecord& why) override {
    expect(first_index == next_index_ && count >= 1);
    next_index_ += count;
    const std::string text = why.text();
    expect(!text.empty());
    digest_.add(text.data(), text.size());
  }

  Result<void> progress(std::uint64_t bytes_done, std::uint64_t bytes_total) override {
    expect(bytes_done >= bytes_done_ && bytes_done <= bytes_total);
    expect(bytes_total >= bytes_total_);
    bytes_total_ = bytes_total;
    bytes_done_ = bytes_done;
    return {};
  }

  void check(const Result<MeshSummary>& summary) const {
    if (!summary) {
      expect(summary.error().code == ErrorCode::kBadInput || lacks_memory(summary));
      expect(summary.error().text[0] != 0);
      return;
    }
    expect(triangle_count_ > 0 && summary->triangle_indices == next_index_);
    expect(float32_ || !summary->float32);
  }

  /// A hash of all calls so far.
  [[nodiscard]] std::uint64_t digest() const { return digest_.value(); }

  /// Whether the mesh was refused because it needs more memory, which a zstd frame may state.
  static bool lacks_memory(const Result<MeshSummary>& summary) {
    return !summary && summary.error().code == ErrorCode::kNoMemory;
  }

  static void expect(bool truth) {
    if (!truth) std::abort();
  }

 private:
  std::uint64_t next_index_ = 0;
  std::uint64_t triangle_count_ = 0, attribute_count_ = 0;
  std::uint64_t bytes_done_ = 0, bytes_total_ = 0;
  Digest digest_;
  bool float32_ = true;  ///< all corners so far are representable as float
};

/// The attributes that the byte in the middle of an input says to keep: none of most inputs, since
/// a mesh that lacks one is refused.
inline std::uint32_t keep_of(const std::uint8_t* bytes, std::size_t size) {
  if (size == 0 || bytes[size / 2] % 4 != 3) return 0;
  return bytes[size / 2] / 4 % 16 & kMeshAttributes;
}

/// Reads with enough memory and with very little. The results must be the same.
///
/// read  (sink, scratch) -> Result<MeshSummary>.
template <class Read>
void read_twice(const Read& read) {
  constexpr std::uint64_t kMuch = std::uint64_t{1} << 20, kLittle = 256;
  CheckingSink one, other;
  MeshScratch much(kMuch, "/dev/shm"), little(kLittle, "/dev/shm");
  const Result<MeshSummary> expected = read(one, much), found = read(other, little);
  one.check(expected);
  other.check(found);
  if (CheckingSink::lacks_memory(expected) || CheckingSink::lacks_memory(found)) return;
  CheckingSink::expect(static_cast<bool>(expected) == static_cast<bool>(found));
  // How much was delivered before structural damage depends on when the damage was found.
  if (expected) CheckingSink::expect(one.digest() == other.digest());
}

}  // namespace planetree::octree
