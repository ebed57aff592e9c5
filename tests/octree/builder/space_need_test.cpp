#include "octree/builder/space_need.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "octree/builder/tree_builder.h"
#include "tests/octree/support/sample_mask.h"
#include "tests/storage/system/faulty_calls.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::octree {
namespace {

constexpr std::uint64_t kMegabyte = 1 << 20;

/// Builds of an ascii PLY with a separate temporary directory.
class BuildSpace : public testing::Test, public BuildProgress {
 protected:
  Result<void> progress(BuildPhase, std::uint64_t, std::uint64_t) override {
    reading_begun_ = true;
    return {};
  }
  void failed_at(BuildDirectory directory, const std::filesystem::path&) override {
    index_ = directory;
  }

  // Writes a torus of quads, or of polygons with more corners that repeat those of a quad.
  void write_torus(unsigned corners, const char* real) const {
    constexpr unsigned kRound = 60, kAlong = 80;
    std::ofstream file(mesh_);
    file << "ply\nformat ascii 1.0\nelement vertex " << kRound * kAlong << "\nproperty " << real
         << " x\nproperty " << real << " y\nproperty " << real << " z\nelement face "
         << kRound * kAlong << "\nproperty list uchar int vertex_indices\nend_header\n";
    for (unsigned i = 0; i < kRound; ++i)
      for (unsigned j = 0; j < kAlong; ++j) {
        const double a = i * 2 * M_PI / kRound, b = j * 2 * M_PI / kAlong;
        const double radius = 3 + std::cos(a);
        file << radius * std::cos(b) << ' ' << radius * std::sin(b) << ' ' << std::sin(a) << '\n';
      }
    for (unsigned i = 0; i < kRound; ++i)
      for (unsigned j = 0; j < kAlong; ++j) {
        const unsigned next_i = (i + 1) % kRound, next_j = (j + 1) % kAlong;
        const unsigned quad[] = {i * kAlong + j, next_i * kAlong + j, next_i * kAlong + next_j,
                                 i * kAlong + next_j};
        file << corners;
        for (unsigned k = 0; k < corners; ++k) file << ' ' << quad[k % 4];
        file << '\n';
      }
  }

  Result<BuildReport> build(const BuildMemory& memory,
                            storage::FileCalls& calls = storage::FileCalls::real()) {
    BuildOptions options;
    options.temp_directory = temporary_ / ".";
    options.replace = true;
    options.box = box_;
    return build_tree(mesh_, output_, options, *this,
                      {kChunkTriangles, kSectorTriangles, memory, calls});
  }
  SpaceNeed need(const BuildMemory& memory) const {
    const auto size = MeshSize::estimate(mesh_);
    EXPECT_TRUE(size);
    return SpaceNeed::before_reading(*size, memory);
  }

  storage::TemporaryDirectory folder_;
  storage::TemporaryDirectory temporary_;
  std::filesystem::path mesh_ = folder_ / "torus.ply";
  std::filesystem::path output_ = folder_ / "torus.ptree";
  std::optional<BuildDirectory> index_;
  std::optional<RegionBox> box_;
  bool reading_begun_ = false;  ///< whether reading has begun
};

constexpr BuildMemory kNothingHeld{1, 700, 65536, 0, 0, 0, 0, 0, 0};
constexpr BuildMemory kPartHeld{1, 700, 65536, 200000, 150000, 70000, 3000, 3000, 3000};
constexpr BuildMemory kAllHeld{1,
                               700,
                               kMegabyte << 5,
                               kMegabyte << 5,
                               kMegabyte << 5,
                               kMegabyte << 5,
                               kMegabyte << 5,
                               kMegabyte << 5,
                               kMegabyte << 5};

TEST_F(BuildSpace, EstimateCoversTheBuildWithAnyMemory) {
  for (const char* real : {"float", "double"}) {
    write_torus(4, real);
    for (const BuildMemory& memory : {kNothingHeld, kPartHeld}) {
      const SpaceNeed foreseen = need(memory);
      const auto report = build(memory);
      ASSERT_TRUE(report) << report.error().text;
      EXPECT_GE(foreseen.temporary_bytes, report->temporary_bytes);
      EXPECT_LE(foreseen.temporary_bytes, 1.5 * static_cast<double>(report->temporary_bytes));
      EXPECT_GE(foreseen.output_bytes, report->header.file_bytes);
      EXPECT_GT(report->temporary_bytes, 100000u);
    }
    EXPECT_EQ(need(kAllHeld).temporary_bytes, 0u);
    EXPECT_EQ(build(kAllHeld)->temporary_bytes, 0u);
  }
}

TEST_F(BuildSpace, IsCheckedBeforeAnythingIsWritten) {
  write_torus(4, "float");
  const SpaceNeed foreseen = need(kNothingHeld);
  storage::FaultyCalls calls;
  calls.device = storage::device_with_free(foreseen.temporary_bytes + foreseen.output_bytes);
  EXPECT_TRUE(build(kNothingHeld, calls));
  std::filesystem::remove(output_);
  calls.device = storage::device_with_free(foreseen.temporary_bytes + foreseen.output_bytes - 1);
  reading_begun_ = false;
  const auto refused = build(kNothingHeld, calls);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNoSpace);
  EXPECT_FALSE(reading_begun_);
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"torus.ply"});
}

// A small region of a mesh that would not fit as a whole.
TEST_F(BuildSpace, OfARegionExcludesTrianglesOutside) {
  write_torus(4, "float");
  const auto size = MeshSize::estimate(mesh_);
  ASSERT_TRUE(size);
  const SpaceNeed cut = SpaceNeed::before_reading(*size, kNothingHeld, true);
  EXPECT_LT(cut.temporary_bytes, need(kNothingHeld).temporary_bytes);
  EXPECT_EQ(cut.output_bytes, 0u);
  storage::FaultyCalls calls;
  calls.device = storage::device_with_free(cut.temporary_bytes);
  EXPECT_FALSE(build(kNothingHeld, calls));
  box_ = {{-100, -100, 0}, {0, 0, 100}};
  const auto report = build(kNothingHeld, calls);
  ASSERT_TRUE(report) << report.error().text;
  EXPECT_LT(report->header.model.triangle_count, size->triangles / 4);
  // The triangles of the region do not fit.
  calls.device = storage::device_with_free(1000);
  EXPECT_FALSE(build(kNothingHeld, calls));
}

// An ascii PLY of polygons with many corners does not reveal the number of triangles before it is
// read.
TEST_F(BuildSpace, IsCheckedAgainOnceTrianglesAreCounted) {
  write_torus(12, "float");
  const SpaceNeed foreseen = need(kNothingHeld);
  storage::FaultyCalls calls;
  calls.device = storage::device_with_free(foreseen.temporary_bytes + foreseen.output_bytes);
  const auto refused = build(kNothingHeld, calls);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNoSpace);
  EXPECT_EQ(index_, BuildDirectory::kTemporary);
  EXPECT_TRUE(reading_begun_);
  EXPECT_EQ(folder_.names(), std::vector<std::string>{"torus.ply"});
}

/// The file systems of two directories.
class Devices final : public storage::FileCalls {
 public:
  std::uint64_t temporary_free = 0, output_free = 0;
  bool shared = false;

  int fstatat(int, const char* path, struct stat* status, int) noexcept override {
    status->st_dev = shared || *path == 't' ? 1 : 2;
    return 0;
  }
  int statvfs(const char* path, struct statvfs* space) noexcept override {
    *space = storage::device_with_free(*path == 't' ? temporary_free : output_free, kMegabyte);
    return 0;
  }
};

struct SpaceCase {
  SpaceNeed need;
  std::uint64_t temporary_free, output_free;
  bool shared;
  BuildDirectory directory;
  std::string text;  // expected error; empty if there is enough space
};

TEST(SpaceNeed, ReportsTheDirectoryAndTheShortage) {
  const SpaceNeed both{30 * kMegabyte, 10 * kMegabyte}, file{0, 10 * kMegabyte - 5};
  const std::string remedy = "free some, name a --temp-dir with more space, or give more --memory";
  const BuildDirectory temporary = BuildDirectory::kTemporary, output = BuildDirectory::kOutput;
  const std::vector<SpaceCase> cases = {
      {both, 30, 10, false, temporary, ""},
      {both, 29, 10, false, temporary,
       "temporary files may take 30 MiB, and the device has 29 MiB free; " + remedy},
      {both, 29, 9, false, output,
       "the output may take 10 MiB, and the device has 9 MiB free; free some, or name an output "
       "on another device"},
      {both, 40, 40, true, temporary, ""},
      {both, 39, 39, true, temporary,
       "temporary files and the output may take 40 MiB, and the device has 39 MiB free; " + remedy},
      {file, 0, 10, false, output, ""},
      {file, 10, 10, true, output, ""},
      {file, 0, 9, false, output,
       "the output may take 10 MiB, and the device has 9 MiB free; free some, or name an output "
       "on another device"}};
  for (const SpaceCase& c : cases) {
    Devices calls;
    calls.temporary_free = c.temporary_free;
    calls.output_free = c.output_free;
    calls.shared = c.shared;
    BuildDirectory directory = BuildDirectory::kInput;
    const auto checked = c.need.check("temporary", "output", calls, directory);
    EXPECT_EQ(checked ? "" : checked.error().text, c.text);
    if (checked) continue;
    EXPECT_EQ(checked.error().code, ErrorCode::kNoSpace);
    EXPECT_EQ(directory, c.directory);
  }
}

TEST(SpaceNeed, PassesWhereFreeSpaceIsUnknown) {
  storage::FaultyCalls calls;
  calls.fault = storage::FaultyCalls::Fault::kError;
  calls.every = true;
  BuildDirectory directory = BuildDirectory::kInput;
  EXPECT_TRUE((SpaceNeed{~std::uint64_t{0}, ~std::uint64_t{0}}).check(".", ".", calls, directory));
}

TEST(SpaceNeed, CountsAttributes) {
  MeshSize size{1'000'000, 500'000, false};
  const BuildMemory memory = *BuildMemory::share(std::uint64_t{8} << 30, 1);
  const SpaceNeed plain = SpaceNeed::before_reading(size, memory);
  size.attributes = kKeepTriangles;
  const SpaceNeed links = SpaceNeed::before_reading(size, memory);
  EXPECT_EQ(links.output_bytes - plain.output_bytes, 4 * size.triangles);
  EXPECT_EQ(links.temporary_bytes - plain.temporary_bytes, 8 * size.triangles);
  size.attributes = kAllAttributes;
  const SpaceNeed all = SpaceNeed::before_reading(size, memory);
  EXPECT_EQ(all.output_bytes - plain.output_bytes, 48 * size.triangles);
  EXPECT_EQ(all.temporary_bytes - plain.temporary_bytes, (44 + 8) * size.triangles);
}

}  // namespace
}  // namespace planetree::octree
