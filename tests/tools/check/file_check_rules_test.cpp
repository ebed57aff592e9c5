#include "tools/check/file_check.h"

#include <gtest/gtest.h>

#include "tests/tools/check/file_check_fixture.h"

namespace planetree::tools {
namespace {

TEST_F(FileCheck, FindsPagesThatDoNotDecompress) {
  Forgery forgery;
  forgery.stored = [](std::uint32_t page, storage::StoredPage& stored) {
    if (page != 1) return;
    stored.codec = storage::Codec::kLz4;
    std::fill(stored.bytes.begin(), stored.bytes.end(), std::byte{0xff});
  };
  EXPECT_EQ(codes_of_forgery(forgery), Codes{"PAGE_CODEC"});
}

TEST_F(FileCheck, FindsPagesWithBadStructure) {
  Forgery forgery;
  forgery.page = [](std::uint32_t page, RawPage& raw) {
    if (page == 0) raw.set<std::uint8_t>("child_counts", 0, 0);
  };
  EXPECT_EQ(codes_of_forgery(forgery), Codes{"PAGE_STRUCTURE"});
}

/// Calls change(raw) for the first page that has at least two links to other pages.
Forgery change_links(const std::function<void(RawPage&)>& change) {
  Forgery forgery;
  forgery.page = [change, done = false](std::uint32_t, RawPage& raw) mutable {
    if (done || raw.elements("linked_pages") < 2) return;
    change(raw);
    done = true;
  };
  return forgery;
}

TEST_F(FileCheck, FindsLinksThatLeadNowhere) {
  // No page of 4 KiB has as many roots as nodes fit.
  const auto forgery =
      change_links([](RawPage& raw) { raw.set<std::uint16_t>("linked_nodes", 0, 11); });
  EXPECT_EQ(codes_of_forgery(forgery), (Codes{"LINK_TARGET", "SUBTREE_UNLINKED"}));
}

TEST_F(FileCheck, FindsTwoLinksToOneSubtree) {
  const auto forgery = change_links([](RawPage& raw) {
    raw.set("linked_pages", 1, raw.get<std::uint32_t>("linked_pages", 0));
    raw.set("linked_nodes", 1, raw.get<std::uint16_t>("linked_nodes", 0));
  });
  const Codes codes = codes_of_forgery(forgery, false);
  EXPECT_TRUE(codes.contains("LINK_TWICE") && codes.contains("SUBTREE_UNLINKED"));
}

TEST_F(FileCheck, FindsBoxesThatDoNotAgreeAcrossPages) {
  Forgery forgery;
  forgery.page = [](std::uint32_t page, RawPage& raw) {
    if (page == 0 || raw.elements("root_boxes") == 0) return;
    raw.set("root_boxes", 3, std::nextafter(raw.get<float>("root_boxes", 3), 9.0f));
  };
  EXPECT_EQ(codes_of_forgery(forgery, false), Codes{"SUBTREE_BOX"});
}

TEST_F(FileCheck, FindsAWrongBoxInTheHeader) {
  EXPECT_EQ(codes_of_model([](auto& model) {
              model.box_upper[1] += 1;
              model.core_upper[1] += 1;
            }),
            (Codes{"ROOT_BOX", "MODEL_BOX"}));
  EXPECT_EQ(codes_of_model([](auto& model) {
              model.box_upper[1] -= 1;
              model.core_upper[1] -= 1;
            }),
            (Codes{"MODEL_BOX", "CAPS"}));
}

TEST_F(FileCheck, FindsWrongHeights) {
  EXPECT_EQ(codes_of_model([](auto& model) { ++model.height; }), Codes{"HEIGHT"});
  // Raises the root's height alone; its highest child is then two lower.
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

// Model::open() does not check the scale.
TEST_F(FileCheck, StopsAtAScaleThatIsNotThatOfTheCore) {
  EXPECT_EQ(codes_of_model([](auto& model) { ++model.scale_exponent; }), Codes{"HEADER_FIELD"});
  EXPECT_EQ(codes_of_model([](auto& model) { --model.scale_exponent; }), Codes{"HEADER_FIELD"});
}

TEST_F(FileCheck, FindsVerticesOutsideTheirBounds) {
  Forgery moved_vertex;
  moved_vertex.page = [](std::uint32_t, RawPage& raw) {
    if (raw.elements("vertices") == 0) return;
    raw.set("vertices", 0, raw.get<float>("vertices", 0) + 0.53f);
  };
  const Codes codes = codes_of_forgery(moved_vertex);
  EXPECT_TRUE(codes.contains("VERTEX_OUTSIDE_BOX") && codes.contains("VERTEX_OUTSIDE_PLANES"));
  EXPECT_EQ(codes_of_forgery(moved_vertex, false), Codes{});
}

TEST_F(FileCheck, FindsDiscsThatDoNotEncloseTheirVertices) {
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
  // In an inner node, far above the vertices that it must enclose.
  EXPECT_EQ(codes_of_forgery(narrowed("child_radii", std::uint16_t{0}, 0)), expected);
}

TEST_F(FileCheck, FindsAWrongSample) {
  EXPECT_EQ(codes_of_model([](auto& model) { model.sample[2] += 1; }), Codes{"SAMPLE"});
  EXPECT_EQ(codes_of_model([](auto& model) { model.sample_triangle = 5; }), Codes{"SAMPLE"});
}

TEST_F(FileCheck, FindsAWrongOpenness) {
  EXPECT_EQ(codes_of_model([](auto& model) { model.openness *= 0.5; }), Codes{"OPENNESS"});
}

TEST_F(FileCheck, FindsWrongUnbalancedEdges) {
  EXPECT_EQ(codes_of_model([](auto& model) { ++model.unbalanced_edge[2].along; }),
            Codes{"UNBALANCED_EDGES"});
  EXPECT_EQ(codes_of_model([](auto& model) {
              std::swap(model.unbalanced_edge[1].from, model.unbalanced_edge[1].to);
            }),
            Codes{"UNBALANCED_EDGES"});
}

TEST_F(FileCheck, FindsWrongMoments) {
  const auto changed = [](std::string_view stream, auto by, std::uint32_t only_page) {
    Forgery forgery;
    forgery.caps = [=](std::uint32_t page, RawPage& raw) {
      if (page != only_page || raw.elements(stream) == 0) return;
      using T = decltype(by);
      raw.set(stream, 0, static_cast<T>(raw.get<T>(stream, 0) + by));
    };
    return forgery;
  };
  const Codes expected = {"MOMENTS"};
  for (const std::uint32_t page : {0u}) {
    EXPECT_EQ(codes_of_forgery(changed("child_dipoles", std::int16_t{9000}, page)), expected);
    EXPECT_EQ(codes_of_forgery(changed("child_quadrupoles", std::int8_t{40}, page)), expected);
    EXPECT_EQ(codes_of_forgery(changed("child_areas", std::uint16_t(-0x0180), page)), expected);
    EXPECT_EQ(codes_of_forgery(changed("child_second_moments", std::uint16_t(-0x0480), page)),
              expected);
    EXPECT_EQ(codes_of_forgery(changed("child_areas", std::uint16_t(-0x0180), page), false),
              Codes{});
  }
}

TEST_F(FileCheck, FindsWrongFiguresOfCaps) {
  EXPECT_EQ(codes_of_model([](auto& model) { model.cap_area *= 1.001; }), Codes{"CAPS"});
  EXPECT_EQ(codes_of_model([](auto& model) { ++model.cap_height; }), Codes{"HEIGHT"});
  EXPECT_EQ(codes_of_model([](auto& model) { --model.cap_node_count; }), Codes{"COUNT"});
  EXPECT_EQ(codes_of_model([](auto& model) { --model.cap_block_count; }), Codes{"COUNT"});
  EXPECT_EQ(codes_of_model([](auto& model) { ++model.cap_count; }), Codes{"COUNT"});
}

TEST_F(FileCheck, FindsCapsThatDoNotCloseTheSurface) {
  Forgery forgery;
  // Moves a vertex of a cap a little.
  bool moved = false;
  forgery.caps = [&moved](std::uint32_t, RawPage& raw) {
    const std::size_t count = raw.elements("vertices");
    for (std::size_t at = 0; !moved && at < count; ++at) {
      const auto old = raw.get<float>("vertices", at);
      if (old < 0.25F) continue;
      raw.set("vertices", at, std::nextafter(old, 0.0F));
      moved = true;
    }
  };
  EXPECT_EQ(codes_of_forgery(forgery), Codes{"CAPS"});
}

TEST_F(FileCheck, CountsIssuesBeyondThoseKept) {
  IssueList list;
  for (int i = 0; i < 1500; ++i) list.add({IssueCode::kDirectory, Error::kNowhere, 0, "x"});
  EXPECT_EQ(list.count(), 1500u);
  EXPECT_EQ(list.kept().size(), IssueList::kMaxKept);
}

TEST(FileCheckOfShapes, AcceptsATreeOfOneBlock) {
  storage::TemporaryDirectory folder;
  write_mesh(folder / "mesh.obj", 1);
  build_sample(folder / "mesh.obj", folder / "tree.ptree");
  const CheckReport report = check(storage::read_bytes(folder / "tree.ptree"));
  EXPECT_EQ(codes_of(report), Codes{});
  EXPECT_EQ(report.nodes, 0u);
  EXPECT_EQ(report.blocks, 2u);  // one is of caps
}

TEST(FileCheckOfShapes, AcceptsDoublesAndSkippedRecords) {
  storage::TemporaryDirectory folder;
  write_mesh(folder / "mesh.obj", 12, "v 0.1 0.2 0.3\nf 1 2 170\nf 1 2 999\nf 1 5 170\n");
  build_sample(folder / "mesh.obj", folder / "tree.ptree");
  const Bytes bytes = storage::read_bytes(folder / "tree.ptree");
  const storage::ModelRecord model = storage::FileImage(bytes).header().model;
  EXPECT_EQ(model.vertex_kind, storage::VertexKind::kFloat64);
  EXPECT_EQ(model.skipped_count, 1u);
  EXPECT_EQ(codes_of(check(bytes)), Codes{});
}

}  // namespace
}  // namespace planetree::tools
