#include "tools/check/file_check.h"

#include <gtest/gtest.h>

#include <sstream>
#include <string>

#include "tests/tools/check/file_check_fixture.h"

namespace planetree::tools {
namespace {

// The surface of a box; each side is a grid of squares.
std::string closed_box(int side) {
  std::ostringstream obj;
  int vertices = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {0, side})
      for (int u = 0; u < side; ++u)
        for (int v = 0; v < side; ++v) {
          const auto corner = [&](int du, int dv) {
            int at[3];
            at[axis] = end;
            at[(axis + 1) % 3] = u + du;
            at[(axis + 2) % 3] = v + dv;
            obj << "v " << at[0] << ' ' << at[1] << ' ' << at[2] << '\n';
          };
          corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1);
          const int a = vertices + 1, b = a + 1, c = a + 2, d = a + 3;
          vertices += 4;
          if (end == 0)
            obj << "f " << a << ' ' << d << ' ' << c << ' ' << b << '\n';
          else
            obj << "f " << a << ' ' << b << ' ' << c << ' ' << d << '\n';
        }
  return obj.str();
}

TEST_F(FileCheck, AcceptsAnIntactFile) {
  const CheckReport report = check(bytes_);
  EXPECT_EQ(codes_of(report), Codes{});
  EXPECT_EQ(report.triangles, 2u * kSide * kSide);
  EXPECT_GT(report.pages, 3u);
  EXPECT_EQ(report.pages, image().header().page_count);
}

// Every single flipped bit must be found, and neither check nor survey may fail because of it.
TEST(FileCheckOfDamage, FindsEveryFlippedBit) {
  storage::TemporaryDirectory folder;
  write_mesh(folder / "mesh.obj", 12);
  build_sample(folder / "mesh.obj", folder / "tree.ptree");
  Bytes bytes = storage::read_bytes(folder / "tree.ptree");
  ASSERT_GT(storage::FileImage(bytes).header().page_count, 2u);
  ASSERT_GT(bytes.size(), 1500u);
  MemoryFile file(bytes);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    const auto mask = std::byte{1} << bit % 8;
    bytes[bit / 8] ^= mask;
    ASSERT_GT(check(file, false).issues.count(), 0u) << "bit " << bit;
    if (bit % 8 == 0) {
      auto parts = FileParts::open("file", file);
      const FileSurvey survey = survey_file(*parts, [](const PageRow&) { return true; });
      ASSERT_GT(survey.issues.count(), 0u) << "bit " << bit;
    }
    bytes[bit / 8] ^= mask;
  }
  EXPECT_EQ(check(bytes).issues.count(), 0u);
}

// Built as large models are: in several chunks, with a mask of many sectors.
TEST(FileCheckOfChunks, AcceptsFilesBuiltInChunks) {
  storage::TemporaryDirectory folder;
  std::ofstream(folder / "closed.obj") << closed_box(12);
  write_mesh(folder / "open.obj", 25);
  for (const char* name : {"closed.obj", "open.obj"}) {
    octree::BuildOptions options;
    options.page_bytes = 4096;
    options.replace = true;
    octree::SilentProgress progress;
    const auto report =
        octree::build_tree(folder / name, folder / "tree.ptree", options, progress, {150, 200, {}});
    ASSERT_TRUE(report) << report.error().text;
    EXPECT_EQ(report->header.model.unbalanced_edge_count == 0, name == std::string("closed.obj"));
    EXPECT_GT(report->header.page_count, 10u);
    auto parts = FileParts::open(folder / "tree.ptree", storage::FileCalls::real());
    ASSERT_TRUE(parts);
    EXPECT_EQ(codes_of(check_file(*parts, true)), Codes{}) << name;
  }
}

TEST(FileCheckOfDamage, FindsEveryTruncation) {
  storage::TemporaryDirectory folder;
  write_mesh(folder / "mesh.obj", 9);
  build_sample(folder / "mesh.obj", folder / "tree.ptree");
  const Bytes bytes = storage::read_bytes(folder / "tree.ptree");
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    const CheckReport report = check(std::span(bytes).first(length));
    const Codes codes = codes_of(report);
    ASSERT_TRUE(codes.contains("FILE_LENGTH") || codes.contains("NOT_PLANETREE")) << length;
  }
  Bytes longer = bytes;
  longer.push_back(std::byte{0});
  EXPECT_TRUE(codes_of(check(longer)).contains("FILE_LENGTH"));
}

TEST_F(FileCheck, RecognisesForeignAndUnsupportedFiles) {
  EXPECT_EQ(codes_of(check(std::as_bytes(std::span("ply\nformat ascii 1.0\n")))),
            Codes{"NOT_PLANETREE"});
  EXPECT_EQ(codes_of(check(Bytes{})), Codes{"NOT_PLANETREE"});
  auto newer = image();
  newer.change_header(
      [](storage::FileHeader& header) { header.version = storage::kFormatVersion + 256; });
  newer.seal_header();
  EXPECT_EQ(codes_of(check(newer.bytes())), Codes{"FORMAT_UNSUPPORTED"});
  auto featured = image();
  featured.change_header([](auto& header) { header.incompatible_features = 4; });
  featured.seal_header();
  EXPECT_EQ(codes_of(check(featured.bytes())), Codes{"FORMAT_UNSUPPORTED"});
}

TEST_F(FileCheck, DistinguishesOneDamagedHeaderFromTwo) {
  auto damaged = image();
  damaged.bytes()[100] ^= std::byte{1};
  const CheckReport one = check(damaged.bytes());
  EXPECT_EQ(codes_of(one), Codes{"HEADER_COPY"});
  EXPECT_EQ(one.triangles, 2u * kSide * kSide);
  damaged.bytes()[damaged.bytes().size() - 100] ^= std::byte{1};
  EXPECT_EQ(codes_of(check(damaged.bytes())), Codes{"HEADER_LOST"});
}

TEST_F(FileCheck, ChecksEachPageWhereTheDirectoryIsDamaged) {
  auto damaged = image();
  damaged.change_entry(1, [](storage::DirectoryPage& entry) { entry.check ^= 1; });
  const CheckReport report = check(damaged.bytes());
  EXPECT_EQ(codes_of(report), (Codes{"DIRECTORY", "PAGE_CHECKSUM"}));
  EXPECT_EQ(report.pages, damaged.header().page_count - 1);
}

TEST_F(FileCheck, RefusesImpossibleEntries) {
  const auto codes_with = [this](const std::function<void(storage::DirectoryPage&)>& change) {
    auto damaged = image();
    damaged.change_entry(1, change);
    damaged.seal_directory();
    damaged.seal_header();
    return codes_of(check(damaged.bytes()));
  };
  const Codes expected = {"DIRECTORY", "PAGE_ENTRY"};
  EXPECT_EQ(codes_with([](auto& entry) { entry.stored_bytes = ~std::uint32_t{0}; }), expected);
  EXPECT_EQ(codes_with([](auto& entry) { entry.raw_bytes = ~std::uint32_t{0}; }), expected);
  EXPECT_EQ(codes_with([](auto& entry) { entry.raw_bytes = 0; }), expected);
}

TEST_F(FileCheck, ContinuesAfterAPageThatCannotBeRead) {
  const auto intact = storage::PageFile::open(tree_);
  ASSERT_TRUE(intact);
  const std::uint64_t offset = intact->entry(2)->offset;
  MemoryFile file(bytes_);
  file.fail_reads_at(offset);
  const CheckReport report = check(file);
  ASSERT_EQ(codes_of(report), Codes{"PAGE_READ"});
  EXPECT_EQ(report.issues.kept()[0].page, 2u);
  EXPECT_EQ(report.issues.kept()[0].offset, offset);
  EXPECT_EQ(report.pages, intact->page_count() - 1);
}

}  // namespace
}  // namespace planetree::tools
