#pragma once

#include <filesystem>
#include <fstream>
#include <functional>

#include "tests/octree/support/sample_mask.h"
#include "tests/tools/check/file_check_fixture.h"
#include "tools/check/file_check.h"

namespace planetree::tools {

using octree::MaskKind;
using octree::RawMaskPage;
using Change = std::function<void(RawMaskPage&)>;

inline void write_soup(const std::filesystem::path& path, const octree::Soup& soup) {
  std::ofstream mesh(path);
  mesh.precision(17);
  std::uint64_t vertex = 0;
  for (const auto& triangle : soup) {
    for (const Vec3& p : triangle) mesh << "v " << p.x << ' ' << p.y << ' ' << p.z << '\n';
    mesh << "f " << vertex + 1 << ' ' << vertex + 2 << ' ' << vertex + 3 << '\n';
    vertex += 3;
  }
}

inline CheckReport check_path(const std::filesystem::path& path, bool full) {
  auto parts = FileParts::open(path);
  EXPECT_TRUE(parts);
  return check_file(*parts, full);
}

class FileCheckOfMasks : public testing::Test {
 protected:
  // Has corner numbers from -1 to 2 and special cells.
  std::filesystem::path boxes() const {
    return PLANETREE_SOURCE_DIR "/format-spec/v1/samples/boxes.ptree";
  }
  // Has a mask of one leaf.
  std::filesystem::path tetrahedron() const {
    return PLANETREE_SOURCE_DIR "/format-spec/v1/samples/tetrahedron.ptree";
  }
  // Has a mask of several pages.
  std::filesystem::path sphere() {
    const std::filesystem::path tree = folder_ / "sphere.ptree";
    if (std::filesystem::exists(tree)) return tree;
    write_soup(folder_ / "sphere.obj", octree::sphere(5));
    build_sample(folder_ / "sphere.obj", tree);
    return tree;
  }
  CheckReport check_forgery(const std::filesystem::path& tree, const Forgery& forgery, bool full) {
    forge(tree, folder_ / "forged.ptree", forgery);
    return check_path(folder_ / "forged.ptree", full);
  }
  // Changes the first mask page for which fits(page) holds.
  Codes codes_of_change(const std::filesystem::path& tree,
                        const std::function<bool(const RawMaskPage&)>& fits, const Change& change,
                        bool full = true) {
    bool done = false;
    Forgery forgery;
    forgery.mask = [&](std::uint32_t, RawMaskPage& page) {
      if (done || !fits(page)) return;
      change(page);
      done = true;
    };
    const Codes codes = codes_of(check_forgery(tree, forgery, full));
    EXPECT_TRUE(done) << "no page of the sample suits";
    return codes;
  }
  // The change is found with --full and not looked for without it.
  template <class Find>
  void expect_found(const char* code, const Find& find, const Change& change) {
    const auto fits = [&](const RawMaskPage& page) { return static_cast<bool>(find(page)); };
    EXPECT_EQ(codes_of_change(boxes(), fits, change), Codes{code});
    EXPECT_EQ(codes_of_change(boxes(), fits, change, false), Codes{});
  }

  storage::TemporaryDirectory folder_;
};

inline bool has_lists(const octree::RawMaskPage& page) { return page.head.listed_count > 0; }

}  // namespace planetree::tools
