#include "octree/builder/tree_builder.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <string>
#include <vector>

#include "storage/file/page_file.h"
#include "tests/octree/support/sample_tree.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::octree {
namespace {

class Recorder final : public BuildProgress {
 public:
  Result<void> progress(BuildPhase phase, std::uint64_t done, std::uint64_t total) override {
    EXPECT_LE(done, total);
    if (!phases.empty() && phases.back() == phase) {
      EXPECT_GE(done, last_done);
    } else {
      phases.push_back(phase);
    }
    last_done = done;
    last_total = total;
    return {};
  }
  std::vector<BuildPhase> phases;
  std::uint64_t last_done = 0, last_total = 0;
};

class TreeBuilder : public testing::Test {
 protected:
  std::filesystem::path write_obj(const Soup& soup, const std::string& more = "") {
    std::ofstream file(folder_ / "model.obj");
    char line[128];
    for (const auto& triangle : soup)
      for (const Vec3& corner : triangle) {
        std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", corner.x, corner.y, corner.z);
        file << line;
      }
    for (std::size_t i = 0; i < soup.size(); ++i)
      file << "f " << 3 * i + 1 << ' ' << 3 * i + 2 << ' ' << 3 * i + 3 << '\n';
    file << more;
    return folder_ / "model.obj";
  }

  Result<BuildReport> build(const BuildOptions& options = {}) {
    return build_tree(folder_ / "model.obj", output(), options, recorder_);
  }
  std::filesystem::path output() const { return folder_ / "model.ptree"; }

  storage::TemporaryDirectory folder_;
  Recorder recorder_;
};

TEST_F(TreeBuilder, WritesTheSameBytesForAnyNumberOfThreads) {
  for (const Soup& soup : {height_field(70), scattered(3000, 0.02), repeated(400)}) {
    write_obj(soup);
    std::vector<storage::Bytes> files;
    for (const unsigned threads : {1u, 2u, 3u}) {
      BuildOptions options;
      options.threads = threads;
      options.page_bytes = 4096;
      options.replace = true;
      ASSERT_TRUE(build(options));
      files.push_back(storage::read_bytes(output()));
    }
    EXPECT_EQ(files[0], files[1]);
    EXPECT_EQ(files[0], files[2]);
  }
}

TEST_F(TreeBuilder, WritesEveryPageSize) {
  write_obj(scattered(1000, 0.05));
  std::uint32_t pages = ~0u;
  for (std::uint32_t page_bytes = 4096; page_bytes <= 262144; page_bytes *= 2) {
    BuildOptions options;
    options.page_bytes = page_bytes;
    options.replace = true;
    const auto report = build(options);
    ASSERT_TRUE(report) << report.error().text;
    EXPECT_EQ(report->header.page_bytes, page_bytes);
    // Pages of the tree.
    EXPECT_LE(report->header.first_cap_page(), pages);
    pages = report->header.first_cap_page();
    const auto file = storage::PageFile::open(output());
    ASSERT_TRUE(file) << file.error().text;
    EXPECT_EQ(file->header().model.triangle_count, 1000u);
  }
  EXPECT_LE(pages, 2u);
}

TEST_F(TreeBuilder, RefusesOtherPageSizes) {
  write_obj(repeated(1));
  for (const std::uint32_t page_bytes : {0u, 2048u, 5000u, 65535u, 524288u, 1u << 31}) {
    BuildOptions options;
    options.page_bytes = page_bytes;
    const auto report = build(options);
    ASSERT_FALSE(report);
    EXPECT_EQ(report.error().code, ErrorCode::kBadArgument);
  }
  EXPECT_FALSE(std::filesystem::exists(output()));
}

TEST_F(TreeBuilder, ReportsTheModel) {
  write_obj(sphere(3), "f 1 2\nf 1 2 99999\n");
  const auto report = build();
  ASSERT_TRUE(report) << report.error().text;
  const storage::ModelRecord& model = report->header.model;
  EXPECT_EQ(model.triangle_count, 512u);
  EXPECT_EQ(model.skipped_count, 2u);
  EXPECT_EQ(model.first_skipped, 512u);
  EXPECT_EQ(model.vertex_count, 3u * 512);
  EXPECT_EQ(model.box_lower[2], -1);
  EXPECT_EQ(model.box_upper[0], 1);
  EXPECT_EQ(model.scale_exponent, -1);
  EXPECT_EQ(model.sample_triangle, 0u);
  EXPECT_EQ(model.vertex_kind, storage::VertexKind::kFloat32);
  EXPECT_NE(report->frame.first_skipped_text.find("line "), std::string::npos);
}

TEST_F(TreeBuilder, RefusesBadRecordsWhenStrict) {
  write_obj(repeated(2), "f 1 2\n");
  BuildOptions options;
  options.strict = true;
  const auto report = build(options);
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kBadInput);
  EXPECT_FALSE(std::filesystem::exists(output()));
}

TEST_F(TreeBuilder, ReplacesAFileOnlyWithReplace) {
  write_obj(repeated(1));
  ASSERT_TRUE(build());
  const auto again = build();
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, ErrorCode::kAlreadyExists);
  BuildOptions options;
  options.replace = true;
  EXPECT_TRUE(build(options));
}

TEST_F(TreeBuilder, ReportsEachPhaseInTurnToItsEnd) {
  write_obj(sphere(4));
  ASSERT_TRUE(build());
  const std::vector<BuildPhase> expected{BuildPhase::kReading,      BuildPhase::kOrdering,
                                         BuildPhase::kMatching,     BuildPhase::kBuildingTree,
                                         BuildPhase::kBuildingMask, BuildPhase::kBuildingField,
                                         BuildPhase::kWriting};
  EXPECT_EQ(recorder_.phases, expected);
  EXPECT_EQ(recorder_.last_done, recorder_.last_total);
}

TEST_F(TreeBuilder, ReportsTheReadersError) {
  const auto report = build();
  ASSERT_FALSE(report);
  EXPECT_EQ(report.error().code, ErrorCode::kNotFound);
}

}  // namespace
}  // namespace planetree::octree
