#pragma once

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>
#include <vector>

#include "octree/builder/mesh/mesh_reader.h"
#include "tests/oracle/brute_force.h"

namespace planetree::oracle {

/// Returns the triangles of a mesh, by index. A failure or a skipped triangle ends the program.
inline std::vector<Corners> triangles_of(const std::filesystem::path& mesh) {
  class Triangles final : public octree::TriangleSink {
   public:
    Result<void> triangle(std::uint64_t index, const std::array<Vec3, 3>& corners) override {
      has_skipped |= index != all.size();
      all.push_back(corners);
      return {};
    }
    void skipped(std::uint64_t, std::uint64_t, const octree::SkippedRecord&) override {}
    Result<void> progress(std::uint64_t, std::uint64_t) override { return {}; }

    std::vector<Corners> all;
    bool has_skipped = false;
  };
  Triangles triangles;
  const auto read = octree::read_mesh(mesh, triangles);
  if (read && !triangles.has_skipped) return std::move(triangles.all);
  std::fprintf(stderr, "%s: %s\n", mesh.c_str(),
               read ? "has skipped triangles" : read.error().text);
  std::exit(1);
}

}  // namespace planetree::oracle
