#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "octree/build/tree_builder.h"
#include "tests/octree/sample_mask.h"
#include "tests/storage/file_image.h"
#include "tests/storage/temporary_directory.h"

namespace planetree::octree {

/// Builds of models of many patches: what large ones are, with sizes so small that tests can
/// look at them.
class SmallPatches : public testing::Test {
 protected:
  // Binary STL, whose corners are floats.
  void write(const Soup& soup) {
    std::ofstream file(mesh_, std::ios::binary);
    const auto put = [&file](const auto& value) {
      file.write(reinterpret_cast<const char*>(&value), sizeof value);
    };
    file << std::string(80, ' ');
    put(static_cast<std::uint32_t>(soup.size()));
    for (const auto& triangle : soup) {
      for (int i = 0; i < 3; ++i) put(0.0f);
      for (const Vec3& corner : triangle)
        for (const double value : {corner.x, corner.y, corner.z}) put(static_cast<float>(value));
      put(std::uint16_t{0});
    }
  }
  storage::Bytes built() const { return storage::read_bytes(output_); }

  storage::TemporaryDirectory folder_;
  storage::TemporaryDirectory meshes_;
  std::filesystem::path mesh_ = meshes_ / "model.stl";
  std::filesystem::path output_ = folder_ / "model.ptree";
};

inline constexpr BuildMemory kRoomy{2, 100000, 0, 1 << 30, 1 << 30, 1 << 30, 1 << 30, 1 << 30};
inline constexpr BuildMemory kTight{1, 77, 65536, 0, 0, 0, 0, 0};
inline constexpr BuildMemory kBetween{3, 200, 65536, 30000, 20000, 7000, 5000, 5000};

}  // namespace planetree::octree
