#include "tools/file_check.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <set>
#include <string>

#include "tests/storage/temporary_directory.h"
#include "tests/tools/sample_tree.h"
#include "tools/file_survey.h"

namespace planetree::tools {
namespace {

using storage::Bytes;
using Codes = std::set<std::string>;

/// A file that is in memory only; reads of some bytes may be made to fail.
class MemoryFile final : public storage::FileCalls {
 public:
  explicit MemoryFile(std::span<const std::byte> bytes) : bytes_(bytes) {}
  void fail_reads_at(std::uint64_t offset) { failing_ = offset; }

  int openat(int, const char*, int, mode_t) noexcept override { return 1000; }
  int close(int) noexcept override { return 0; }
  int fstat(int, struct stat* status) noexcept override {
    *status = {};
    status->st_mode = S_IFREG;
    status->st_size = static_cast<off_t>(bytes_.size());
    return 0;
  }
  ssize_t pread(int, void* out, std::size_t bytes, off_t offset) noexcept override {
    const auto begin = std::min(static_cast<std::size_t>(offset), bytes_.size());
    if (begin == failing_) {
      errno = EIO;
      return -1;
    }
    const std::size_t count = std::min(bytes, bytes_.size() - begin);
    std::memcpy(out, bytes_.data() + begin, count);
    return static_cast<ssize_t>(count);
  }

 private:
  std::span<const std::byte> bytes_;
  std::uint64_t failing_ = ~std::uint64_t{0};
};

CheckReport check(storage::FileCalls& calls, bool full = true) {
  auto parts = FileParts::open("file", calls);
  EXPECT_TRUE(parts);
  return check_file(*parts, full);
}

CheckReport check(std::span<const std::byte> bytes, bool full = true) {
  MemoryFile file(bytes);
  return check(file, full);
}

Codes codes_of(const CheckReport& report) {
  Codes codes;
  for (const Issue& issue : report.issues.kept()) {
    codes.insert(std::string(issue_name(issue.code)));
    EXPECT_FALSE(issue.message.empty());
    EXPECT_EQ(issue.message.find('\n'), std::string::npos);
  }
  return codes;
}

class FileCheck : public testing::Test {
 protected:
  static constexpr unsigned kSide = 14;

  void SetUp() override {
    write_mesh(folder_ / "mesh.obj", kSide);
    build_sample(folder_ / "mesh.obj", tree_);
    bytes_ = storage::read_bytes(tree_);
  }
  storage::FileImage image() const { return storage::FileImage(bytes_); }

  Codes codes_of_forgery(const Forgery& forgery, bool full = true) {
    forge(tree_, folder_ / "forged.ptree", forgery);
    return codes_of(check(storage::read_bytes(folder_ / "forged.ptree"), full));
  }
  Codes codes_of_model(const std::function<void(storage::ModelRecord&)>& change) {
    Forgery forgery;
    forgery.model = change;
    return codes_of_forgery(forgery);
  }

  storage::TemporaryDirectory folder_;
  std::filesystem::path tree_ = folder_ / "tree.ptree";
  Bytes bytes_;
};

TEST_F(FileCheck, FindsNothingInAFileThatIsWell) {
  const CheckReport report = check(bytes_);
  EXPECT_EQ(codes_of(report), Codes{});
  EXPECT_EQ(report.triangles, 2u * kSide * kSide);
  EXPECT_GT(report.pages, 3u);
  EXPECT_EQ(report.pages, image().header().page_count);
}

// A single bit wrong anywhere, and a single byte missing, must be found; and
// neither the check nor the survey may stumble over it.
TEST(FileCheckOfDamage, FindsEverySingleBit) {
  storage::TemporaryDirectory folder;
  write_mesh(folder / "mesh.obj", 9);
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
  EXPECT_EQ(check(file).issues.count(), 0u);
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

TEST_F(FileCheck, TellsWhatKindOfFileItIs) {
  EXPECT_EQ(codes_of(check(std::as_bytes(std::span("ply\nformat ascii 1.0\n")))),
            Codes{"NOT_PLANETREE"});
  EXPECT_EQ(codes_of(check(Bytes{})), Codes{"NOT_PLANETREE"});
  auto newer = image();
  newer.change_header([](storage::FileHeader& header) { header.version = 2; });
  newer.seal_header();
  EXPECT_EQ(codes_of(check(newer.bytes())), Codes{"FORMAT_UNSUPPORTED"});
  auto featured = image();
  featured.change_header([](auto& header) { header.incompatible_features = 4; });
  featured.seal_header();
  EXPECT_EQ(codes_of(check(featured.bytes())), Codes{"FORMAT_UNSUPPORTED"});
}

TEST_F(FileCheck, TellsOneDamagedHeaderFromTwo) {
  auto damaged = image();
  damaged.bytes()[100] ^= std::byte{1};
  const CheckReport one = check(damaged.bytes());
  EXPECT_EQ(codes_of(one), Codes{"HEADER_COPY"});
  EXPECT_EQ(one.triangles, 2u * kSide * kSide);
  damaged.bytes()[damaged.bytes().size() - 100] ^= std::byte{1};
  EXPECT_EQ(codes_of(check(damaged.bytes())), Codes{"HEADER_LOST"});
}

TEST_F(FileCheck, JudgesPagesOneByOneWhereTheTableIsDamaged) {
  auto damaged = image();
  damaged.change_entry(1, [](storage::PageEntry& entry) { entry.check ^= 1; });
  const CheckReport report = check(damaged.bytes());
  EXPECT_EQ(codes_of(report), (Codes{"TABLE", "PAGE_CHECKSUM"}));
  EXPECT_EQ(report.pages, damaged.header().page_count - 1);
}

TEST_F(FileCheck, RefusesEntriesThatCannotBe) {
  const auto codes_with = [this](const std::function<void(storage::PageEntry&)>& change) {
    auto damaged = image();
    damaged.change_entry(1, change);
    damaged.seal_table();
    damaged.seal_header();
    return codes_of(check(damaged.bytes()));
  };
  const Codes expected = {"TABLE", "PAGE_ENTRY"};
  EXPECT_EQ(codes_with([](auto& entry) { entry.offset = ~std::uint64_t{0}; }), expected);
  EXPECT_EQ(codes_with([](auto& entry) { entry.stored_bytes = ~std::uint32_t{0}; }), expected);
  EXPECT_EQ(codes_with([](auto& entry) { entry.raw_bytes = ~std::uint32_t{0}; }), expected);
  EXPECT_EQ(codes_with([](auto& entry) { entry.codec = storage::Codec{7}; }), expected);
}

TEST_F(FileCheck, GoesOnWhereThePageCannotBeRead) {
  const auto intact = storage::PageFile::open(tree_);
  ASSERT_TRUE(intact);
  const std::uint64_t offset = intact->entries()[2].offset;
  MemoryFile file(bytes_);
  file.fail_reads_at(offset);
  const CheckReport report = check(file);
  ASSERT_EQ(codes_of(report), Codes{"PAGE_READ"});
  EXPECT_EQ(report.issues.kept()[0].page, 2u);
  EXPECT_EQ(report.issues.kept()[0].offset, offset);
  EXPECT_EQ(report.pages, intact->page_count() - 1);
}

TEST_F(FileCheck, FindsPagesThatDoNotUnpack) {
  Forgery forgery;
  forgery.stored = [](std::uint32_t page, storage::StoredPage& stored) {
    if (page != 1) return;
    stored.codec = storage::Codec::kLz4;
    std::fill(stored.bytes.begin(), stored.bytes.end(), std::byte{0xff});
  };
  EXPECT_EQ(codes_of_forgery(forgery), Codes{"PAGE_CODEC"});
}

TEST_F(FileCheck, FindsPagesThatBreakTheirRules) {
  Forgery forgery;
  forgery.page = [](std::uint32_t page, RawPage& raw) {
    if (page == 0) raw.set<std::uint8_t>("child_counts", 0, 0);
  };
  EXPECT_EQ(codes_of_forgery(forgery), Codes{"PAGE_STRUCTURE"});
}

/// Calls change(raw) for the first page that has at least two links to others.
Forgery change_links(const std::function<void(RawPage&)>& change) {
  Forgery forgery;
  forgery.page = [change, done = false](std::uint32_t, RawPage& raw) mutable {
    if (done || raw.elements("page_links") < 2) return;
    change(raw);
    done = true;
  };
  return forgery;
}

TEST_F(FileCheck, FindsLinksThatLeadNowhere) {
  const auto forgery = change_links(
      [](RawPage& raw) { raw.set("page_links", 0, raw.get<std::uint32_t>("page_links", 0) + 1); });
  EXPECT_EQ(codes_of_forgery(forgery), (Codes{"LINK_TARGET", "SUBTREE_UNLINKED"}));
  const auto kind = change_links([](RawPage& raw) {
    raw.set("page_links", 0, raw.get<std::uint32_t>("page_links", 0) ^ (1u << 31));
  });
  EXPECT_EQ(codes_of_forgery(kind), (Codes{"LINK_TARGET", "SUBTREE_UNLINKED"}));
}

TEST_F(FileCheck, FindsTwoLinksToOneSubtree) {
  const auto forgery = change_links(
      [](RawPage& raw) { raw.set("page_links", 1, raw.get<std::uint32_t>("page_links", 0)); });
  const Codes codes = codes_of_forgery(forgery, false);
  EXPECT_TRUE(codes.contains("LINK_TWICE") && codes.contains("SUBTREE_UNLINKED"));
}

TEST_F(FileCheck, FindsARootThatIsNotThere) {
  EXPECT_TRUE(codes_of_model([](auto& model) { model.root_link += 1; }).contains("LINK_TARGET"));
  EXPECT_TRUE(codes_of_model([](auto& model) {
                model.root_link = ~std::uint32_t{0};
              }).contains("LINK_TARGET"));
}

TEST_F(FileCheck, FindsBoxesThatDoNotAgreeAcrossPages) {
  Forgery forgery;
  forgery.page = [](std::uint32_t page, RawPage& raw) {
    if (page == 0 || raw.elements("root_boxes") == 0) return;
    raw.set("root_boxes", 3, std::nextafter(raw.get<float>("root_boxes", 3), 9.0f));
  };
  EXPECT_EQ(codes_of_forgery(forgery, false), Codes{"SUBTREE_BOX"});
}

TEST_F(FileCheck, FindsAHeaderWhoseBoxIsNotTheModels) {
  EXPECT_EQ(codes_of_model([](auto& model) { model.box_upper[1] += 1; }),
            (Codes{"ROOT_BOX", "MODEL_BOX"}));
  EXPECT_EQ(codes_of_model([](auto& model) { model.box_upper[1] -= 1; }), Codes{"MODEL_BOX"});
}

TEST_F(FileCheck, FindsHeightsThatAreNot) {
  EXPECT_EQ(codes_of_model([](auto& model) { ++model.height; }), Codes{"HEIGHT"});
  // The root's height alone: the highest below it then has two less.
  Forgery forgery;
  forgery.page = [](std::uint32_t page, RawPage& raw) {
    if (page == 0)
      raw.set<std::uint8_t>("heights", 0,
                            static_cast<std::uint8_t>(raw.get<std::uint8_t>("heights", 0) + 1));
  };
  forgery.model = [](storage::ModelRecord& model) { ++model.height; };
  EXPECT_EQ(codes_of_forgery(forgery), Codes{"HEIGHT"});
}

TEST_F(FileCheck, FindsCountsThatDoNotAddUp) {
  EXPECT_EQ(codes_of_model([](auto& model) { ++model.node_count; }), Codes{"COUNT"});
  EXPECT_EQ(codes_of_model([](auto& model) { --model.block_count; }), Codes{"COUNT"});
  EXPECT_EQ(codes_of_model([](auto& model) { ++model.triangle_count; }), Codes{"COUNT"});
}

TEST_F(FileCheck, FindsTrianglesOutOfRangeOrTwice) {
  EXPECT_EQ(codes_of_model([](auto& model) { --model.triangle_count; }),
            (Codes{"COUNT", "TRIANGLE_RANGE"}));
  Forgery forgery;
  forgery.page = [](std::uint32_t, RawPage& raw) {
    if (raw.elements("first_ids") == 0) return;
    raw.set<std::uint32_t>("first_ids", 0, 1);
  };
  EXPECT_TRUE(codes_of_forgery(forgery).contains("TRIANGLE_TWICE"));
  EXPECT_FALSE(codes_of_forgery(forgery, false).contains("TRIANGLE_TWICE"));
}

TEST_F(FileCheck, FindsHeadersThatContradictThemselves) {
  EXPECT_EQ(codes_of_model([](auto& model) { model.first_set_aside = 3; }), Codes{"HEADER_FIELD"});
  EXPECT_EQ(codes_of_model([](auto& model) { model.set_aside_count = 3; }), Codes{"HEADER_FIELD"});
  EXPECT_TRUE(codes_of_model([](auto& model) {
                model.set_aside_count = ~std::uint64_t{0};
              }).contains("HEADER_FIELD"));
  EXPECT_TRUE(
      codes_of_model([](auto& model) { model.triangle_count = 0; }).contains("HEADER_FIELD"));
}

TEST_F(FileCheck, FindsVerticesOutsideTheirBounds) {
  Forgery moved;
  moved.page = [](std::uint32_t, RawPage& raw) {
    if (raw.elements("vertices") == 0) return;
    raw.set("vertices", 0, raw.get<float>("vertices", 0) + 0.5f);
  };
  const Codes codes = codes_of_forgery(moved);
  EXPECT_TRUE(codes.contains("VERTEX_OUTSIDE_BOX") && codes.contains("VERTEX_OUTSIDE_PLANES"));
  EXPECT_EQ(codes_of_forgery(moved, false), Codes{});
}

TEST_F(FileCheck, FindsPlanesThatDoNotEnclose) {
  const auto narrowed = [](std::string_view stream, auto value, std::uint32_t only_page) {
    Forgery forgery;
    forgery.page = [=](std::uint32_t page, RawPage& raw) {
      if (page == only_page && raw.elements(stream) > 0) raw.set(stream, 0, value);
    };
    return forgery;
  };
  const Codes expected = {"VERTEX_OUTSIDE_PLANES"};
  EXPECT_EQ(codes_of_forgery(narrowed("child_radii", std::uint16_t{0}, 1)), expected);
  EXPECT_EQ(codes_of_forgery(narrowed("child_slabs", std::int16_t{0}, 1)), expected);
  // Of an inner node, far above the vertices it should hold.
  EXPECT_EQ(codes_of_forgery(narrowed("child_radii", std::uint16_t{0}, 0)), expected);
}

TEST_F(FileCheck, FindsASampleThatIsNone) {
  EXPECT_EQ(codes_of_model([](auto& model) { model.sample[2] += 1; }), Codes{"SAMPLE"});
  EXPECT_EQ(codes_of_model([](auto& model) { model.sample_triangle = 5; }), Codes{"SAMPLE"});
}

TEST_F(FileCheck, CountsWhatItDoesNotKeep) {
  IssueList list;
  for (int i = 0; i < 1500; ++i) list.add({IssueCode::kTable, Error::kNowhere, 0, "x"});
  EXPECT_EQ(list.count(), 1500u);
  EXPECT_EQ(list.kept().size(), IssueList::kMostKept);
}

TEST(FileCheckOfShapes, AcceptsABlockThatIsTheWholeTree) {
  storage::TemporaryDirectory folder;
  write_mesh(folder / "mesh.obj", 1);
  build_sample(folder / "mesh.obj", folder / "tree.ptree");
  const CheckReport report = check(storage::read_bytes(folder / "tree.ptree"));
  EXPECT_EQ(codes_of(report), Codes{});
  EXPECT_EQ(report.nodes, 0u);
  EXPECT_EQ(report.blocks, 1u);
}

TEST(FileCheckOfShapes, AcceptsDoublesAndSetAsideRecords) {
  storage::TemporaryDirectory folder;
  write_mesh(folder / "mesh.obj", 12, "v 0.1 0.2 0.3\nf 1 2 170\nf 1 2 999\nf 1 5 170\n");
  build_sample(folder / "mesh.obj", folder / "tree.ptree");
  const Bytes bytes = storage::read_bytes(folder / "tree.ptree");
  const storage::ModelRecord model = storage::FileImage(bytes).header().model;
  EXPECT_EQ(model.vertex_kind, storage::VertexKind::kFloat64);
  EXPECT_EQ(model.set_aside_count, 1u);
  EXPECT_EQ(codes_of(check(bytes)), Codes{});
}

}  // namespace
}  // namespace planetree::tools
