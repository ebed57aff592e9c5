// Disk space of builds, compared with the prediction, on surfaces of realistic sizes.

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

#include "octree/builder/space_need.h"
#include "tests/storage/file/file_image.h"
#include "tests/tools/cli/command_fixture.h"

namespace planetree::tools {
namespace {

// So little memory that nothing is held in it.
constexpr const char* kMin = "160M";

octree::SpaceNeed foreseen_of(const fs::path& mesh) {
  const auto size = octree::MeshSize::estimate(mesh);
  const auto memory = octree::BuildMemory::share(octree::BuildMemory::kMinBytes, 1);
  EXPECT_TRUE(size && memory);
  return octree::SpaceNeed::before_reading(*size, *memory);
}

// Writes the same mesh with double coordinates that no float represents. `from` is a file written
// by `planetree generate`.
void widen(const fs::path& from, const fs::path& to) {
  const storage::Bytes bytes = storage::read_bytes(from);
  std::string text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  const std::size_t body = text.find("end_header\n") + 11;
  const std::size_t count = std::stoul(text.substr(text.find("element vertex ") + 15));
  std::string header = text.substr(0, body), wide;
  for (const char* axis : {" x", " y", " z"}) {
    const std::size_t at = header.find(std::string("property float") + axis);
    ASSERT_NE(at, std::string::npos);
    header.replace(at, 14, "property double");
  }
  for (std::size_t i = 0; i < 3 * count; ++i) {
    float narrow = 0;
    std::memcpy(&narrow, &text[body + i * sizeof narrow], sizeof narrow);
    const double value = static_cast<double>(narrow) / 3;
    wide.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::ofstream(to, std::ios::binary)
      << header << wide << text.substr(body + 3 * count * sizeof(float));
}

class BuildSpace : public Command {
 protected:
  void expect_foreseen(const fs::path& mesh, const std::string& page_bytes = "64K",
                       bool resume = false) {
    SCOPED_TRACE(mesh.string() + " " + page_bytes);
    const octree::SpaceNeed need = foreseen_of(mesh);
    std::vector<std::string> arguments = {"build",    mesh.string(), "-o",          "new.ptree",
                                          "--memory", kMin,          "--page-size", page_bytes,
                                          "--force",  "--json",      "--quiet"};
    if (resume) arguments.emplace_back("--resume");
    const Outcome built = run(arguments);
    ASSERT_EQ(built.status, 0) << built.errors;
    const Json report = Json::parse(built.output);
    const auto temporary = report["temporary_bytes"].get<double>();
    const auto output = report["file_bytes"].get<double>();
    EXPECT_GE(static_cast<double>(need.temporary_bytes), temporary);
    EXPECT_LE(static_cast<double>(need.temporary_bytes), 1.25 * temporary);
    EXPECT_GE(static_cast<double>(need.output_bytes), output);
    // LZ4 compresses regular surfaces well.
    EXPECT_LE(static_cast<double>(need.output_bytes), 4.5 * output);
  }
};

// Fewer in builds with sanitizers, which are slow here.
#ifdef NDEBUG
constexpr const char* kTriangleCount = "60K";
#else
constexpr const char* kTriangleCount = "30K";
#endif

TEST_F(BuildSpace, PredictedSpaceIsEnoughAndLittleMore) {
  for (const char* shape : {"statue", "cylinder", "terrain", "soup"}) {
    ASSERT_EQ(
        run({"generate", "shape.ply", "--shape", shape, "--triangles", kTriangleCount, "--force"})
            .status,
        0);
    fs::rename("shape.ply", shape);
    widen(shape, "wide.ply");
    expect_foreseen(shape);
    expect_foreseen("wide.ply");
  }
  expect_foreseen("statue", "4K");
  expect_foreseen("statue", "4K", true);
  expect_foreseen("wide.ply", "256K");
}

TEST_F(BuildSpace, PredictedSpaceOfRealMeshesIsEnoughAndLittleMore) {
  const char* folder = std::getenv("PLANETREE_DATA");
  if (folder == nullptr) GTEST_SKIP() << "PLANETREE_DATA names no folder of meshes";
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".ply") expect_foreseen(entry.path());
}

TEST_F(BuildSpace, TemporaryBytesAreReported) {
  const auto temporary_bytes = [](const std::vector<std::string>& how) {
    std::vector<std::string> arguments = {"build",   "mesh.obj", "-o",      "new.ptree",
                                          "--force", "--json",   "--quiet", "--memory"};
    arguments.insert(arguments.end(), how.begin(), how.end());
    const Outcome built = run(arguments);
    return Json::parse(built.output)["temporary_bytes"].get<std::uint64_t>();
  };
  EXPECT_EQ(temporary_bytes({"8G"}), 0u);
  EXPECT_GT(temporary_bytes({"8G", "--resume"}), kTriangles * (16 + 36));
  // Each triangle twice, with code, index and nine coordinates, and its page.
  EXPECT_GT(temporary_bytes({kMin}), kTriangles * 2 * (16 + 36));
}

}  // namespace
}  // namespace planetree::tools
