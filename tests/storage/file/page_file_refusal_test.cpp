#include "tests/storage/file/page_file_refusal.h"

#include <cmath>
#include <functional>

namespace planetree::storage {
namespace {

TEST_F(PageFileRefusal, AcceptsTheSampleSealedAgain) {
  FileImage image = good();
  image.seal();
  EXPECT_EQ(image.bytes(), good_);
  EXPECT_EQ(refusal_of(image).text[0], 0);
}

TEST_F(PageFileRefusal, RefusesOtherVersionsAndUnknownFeatures) {
  expect_header_refused([](FileHeader& h) { h.version = 1; }, ErrorCode::kUnsupported, "version 1");
  expect_header_refused([](FileHeader& h) { h.version = 0; }, ErrorCode::kUnsupported, "version 0");
  expect_header_refused([](FileHeader& h) { h.incompatible_features = 0x20; },
                        ErrorCode::kUnsupported, "0x20");
  // Another version may have another header.
  FileImage image = good();
  image.change_header([](FileHeader& h) { h.version = 0x203; });
  std::memset(image.bytes().data() + image.bytes().size() - kHeaderBytes, 0, kHeaderBytes);
  expect_refused(image, ErrorCode::kUnsupported, "format version 2.3");
  image = good();
  image.change_header([](FileHeader& h) { h.version = 14; });
  std::memset(image.bytes().data() + image.bytes().size() - kHeaderBytes, 0, kHeaderBytes);
  expect_refused(image, ErrorCode::kUnsupported, "format version 14, from before 1.0");
}

TEST_F(PageFileRefusal, AcceptsLaterMinorVersions) {
  FileImage image = good();
  image.change_header([](FileHeader& h) { h.version = 0x1ff; });
  image.seal_header();
  EXPECT_EQ(refusal_of(image).text[0], 0);
}

TEST_F(PageFileRefusal, AcceptsUnknownCompatibleFeatures) {
  FileImage image = good();
  image.change_header([](FileHeader& h) { h.compatible_features = ~std::uint64_t{0}; });
  image.seal_header();
  EXPECT_EQ(refusal_of(image).text[0], 0);
}

TEST_F(PageFileRefusal, RefusesWrongFileLengths) {
  const std::uint64_t length = good_.size();
  const auto said = [](std::uint64_t expected, std::uint64_t found) {
    return "should have " + std::to_string(expected) + " bytes and has " + std::to_string(found);
  };
  FileImage longer = good();
  longer.bytes().resize(length + 5);
  expect_refused(longer, ErrorCode::kTruncated, said(length, length + 5).c_str());
  FileImage shorter = good();
  shorter.bytes().resize(length - 1);
  expect_refused(shorter, ErrorCode::kTruncated, said(length, length - 1).c_str());
  expect_header_refused([](FileHeader& h) { h.file_bytes = ~std::uint64_t{0}; },
                        ErrorCode::kTruncated, said(~std::uint64_t{0}, length).c_str());
}

TEST_F(PageFileRefusal, RefusesBadHeaderFields) {
  const auto expect_damaged = [&](const std::function<void(FileHeader&)>& change,
                                  const char* said) {
    expect_header_refused(change, ErrorCode::kDamaged, said);
  };
  expect_damaged([](FileHeader& h) { h.header_bytes = 504; }, "header's length");
  for (const std::uint32_t bytes : {0u, 2048u, 4095u, 5000u, 524288u, ~0u}) {
    expect_damaged([&](FileHeader& h) { h.page_bytes = bytes; }, "page size");
  }
  expect_damaged([](FileHeader& h) { h.page_count = 0; }, "no page");
  expect_damaged([](FileHeader& h) { h.page_count = ~0u; }, "directory does not fit");
  expect_damaged([](FileHeader& h) { h.page_count = 100; }, "directory does not fit");
  expect_damaged([](FileHeader& h) { h.max_raw_bytes = 0; }, "largest raw page");
  expect_damaged([](FileHeader& h) { h.max_raw_bytes = 4 * kMaxPageBytes + 1; },
                 "largest raw page");
  expect_damaged([](FileHeader& h) { h.max_raw_bytes = ~0u; }, "largest raw page");
  expect_damaged([](FileHeader& h) { h.max_stored_bytes = 0; }, "largest stored page");
  expect_damaged([](FileHeader& h) { h.max_stored_bytes = ~0u; }, "largest stored page");
  expect_damaged([](FileHeader& h) { h.extension_count = kMaxExtensions + 1; }, "does not fit");
  expect_damaged([](FileHeader& h) { h.extension_count = ~0u; }, "does not fit");
  for (unsigned kind = 0; kind < kPageKinds; ++kind)
    expect_damaged([&](FileHeader& h) { h.stored_bytes[kind] = ~std::uint64_t{0}; }, "do not fit");
  expect_damaged([](FileHeader& h) { h.reserved[0] = 1; }, "reserved");
  expect_damaged([](FileHeader& h) { h.reserved[std::size(FileHeader{}.reserved) - 1] = 1; },
                 "reserved");
}

TEST_F(PageFileRefusal, RefusesBadModelFields) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double value : {kNan, kInfinity, -kInfinity}) {
      expect_model_refused([&](ModelRecord& m) { m.box_lower[axis] = value; }, "box is not finite");
      expect_model_refused([&](ModelRecord& m) { m.box_upper[axis] = value; }, "box is not finite");
      expect_model_refused([&](ModelRecord& m) { m.centre[axis] = value; }, "centre");
      expect_model_refused([&](ModelRecord& m) { m.sample[axis] = value; }, "sample");
    }
    expect_model_refused(
        [&](ModelRecord& m) { m.box_lower[axis] = std::nextafter(m.box_upper[axis], kInfinity); },
        "inside out");
  }
  for (const std::int32_t exponent : {-1201, 1201, INT32_MIN, INT32_MAX}) {
    expect_model_refused([&](ModelRecord& m) { m.scale_exponent = exponent; }, "scale");
  }
  expect_model_refused([](ModelRecord& m) { m.vertex_kind = VertexKind{2}; }, "kind of vertices");
  for (const int bytes : {0, 3, 5, 16, 255}) {
    expect_model_refused([&](ModelRecord& m) { m.triangle_id_bytes = std::uint8_t(bytes); },
                         "triangle indices");
  }
  expect_model_refused([](ModelRecord& m) { m.height = 97; }, "height");
  expect_model_refused([](ModelRecord& m) { m.mask_page_count = ~0u; }, "no page of the tree");
  expect_model_refused([](ModelRecord& m) { m.mask_cell_count = 1; }, "mask's size");
  expect_model_refused([](ModelRecord& m) { m.mask_page_count = 1; }, "mask's size");
  expect_model_refused([](ModelRecord& m) { m.mask_levels = 1; }, "mask's size");
  expect_model_refused([](ModelRecord& m) { m.mask_reserved[2] = 1; }, "mask's reserved");
  expect_model_refused(
      [](ModelRecord& m) {
        m.mask_cell_count = m.mask_page_count = 1;
        m.mask_levels = 20;
      },
      "mask's size");
  for (const int at : {0, 8}) {
    expect_model_refused([&](ModelRecord& m) { m.reserved[at] = 1; }, "reserved");
  }
}

TEST_F(PageFileRefusal, RefusesBadFields) {
  const auto with_grid = [](ModelRecord& m) {
    m.field_step = m.field_quantum = 0.5;
    m.field_size[0] = m.field_size[1] = m.field_size[2] = 2;
  };
  expect_model_refused(with_grid, "as many pages as its points");
  expect_model_refused([](ModelRecord& m) { m.field_page_count = 1; }, "as many pages");
  expect_model_refused([](ModelRecord& m) { m.field_step = 1; }, "grid is out of range");
  expect_model_refused([](ModelRecord& m) { m.field_lower[2] = 1; }, "grid is out of range");
  expect_model_refused(
      [](ModelRecord& m) { m.field_size[0] = m.field_size[1] = m.field_size[2] = 0xffffffff; },
      "as many pages");
}

TEST_F(PageFileRefusal, RefusesBadRulesForSides) {
  for (const double openness : {-0x1p-1074, 1.0000001, kNan, kInfinity})
    expect_model_refused([&](ModelRecord& m) { m.openness = openness; }, "openness");
  expect_model_refused([](ModelRecord& m) { m.side_rule = SideRule{2}; }, "rule for sides is unkn");
  expect_model_refused([](ModelRecord& m) { m.side_is_chosen = 2; }, "neither 0 nor 1");
  expect_model_refused([](ModelRecord& m) { m.side_rule = SideRule::kSurface; }, "for a sheet");
  for (const int at : {0, 4})
    expect_model_refused([&](ModelRecord& m) { m.side_reserved[at] = 1; }, "reserved");
}

TEST_F(PageFileRefusal, RefusesSidesInAFileWithoutSides) {
  const UnbalancedEdge edge{{0, 0, 0}, {1, 0, 0}, 0, 1, 0};
  const auto without_sides = [&](ModelRecord& m) {
    m.without_sides = 1;
    m.mask_page_count = 0;
    m.mask_cell_count = 0;
    m.mask_levels = 0;
    m.unbalanced_edge_count = 1;
    m.unbalanced_edge[0] = edge;
  };
  expect_model_accepted(without_sides);
  const auto expect_side_refused = [&](const ModelChange& change, const char* said) {
    expect_changed_model_refused(without_sides, change, said);
  };
  expect_side_refused([](ModelRecord& m) { m.without_sides = 2; }, "neither 0 nor 1");
  expect_side_refused([](ModelRecord& m) { m.without_sides = 0; }, "caps are not those");
  expect_side_refused([](ModelRecord& m) { m.mask_cell_count = m.mask_page_count = 1; }, "a mask");
  expect_side_refused([](ModelRecord& m) { m.cap_count = m.cap_block_count = 1; },
                      "caps are not those");
  expect_side_refused(
      [](ModelRecord& m) {
        m.input_triangles = m.triangle_count;
        for (int axis = 0; axis < 3; ++axis) {
          m.region_lower[axis] = m.box_lower[axis];
          m.region_upper[axis] = m.box_upper[axis];
        }
        m.region_winding = 1;
      },
      "has a winding number");
}

TEST_F(PageFileRefusal, AcceptsAChosenRuleForSides) {
  FileImage image = good();
  image.change_header([](FileHeader& h) {
    h.model.side_rule = SideRule::kSurface;
    h.model.side_is_chosen = 1;
    h.model.openness = 1;
  });
  image.seal_header();
  EXPECT_EQ(refusal_of(image).text[0], 0);
}

TEST_F(PageFileRefusal, RefusesUnbalancedEdgesThatDisagreeWithTheirCount) {
  const UnbalancedEdge edge{{0, 0, 0}, {1, 0, 0}, 0, 1, 0};
  for (const std::uint64_t count : {0u, 2u, 3u})
    expect_model_refused(
        [&](ModelRecord& m) {
          m.unbalanced_edge_count = count;
          m.unbalanced_edge[0] = edge;
        },
        "as long as their count");
  expect_model_refused(
      [&](ModelRecord& m) {
        m.unbalanced_edge_count = 1;
        m.unbalanced_edge[0] = edge;
        m.unbalanced_edge[0].against = 1;
      },
      "is not unbalanced");
  for (const double value : {kNan, kInfinity})
    expect_model_refused(
        [&](ModelRecord& m) {
          m.unbalanced_edge_count = 1;
          m.unbalanced_edge[0] = edge;
          m.unbalanced_edge[0].to[2] = value;
        },
        "is not unbalanced");
}

TEST_F(PageFileRefusal, RefusesCapsThatAreNotThoseOfTheEdges) {
  const UnbalancedEdge edge{{0, 0, 0}, {1, 0, 0}, 0, 1, 0};
  const auto open = [&](ModelRecord& m) {
    m.unbalanced_edge_count = 1;
    m.unbalanced_edge[0] = edge;
    m.cap_count = m.cap_block_count = 1;
    m.cap_page_count = 1;
    m.cap_area = 0.5;
  };
  using Change = std::function<void(ModelRecord&)>;
  for (const Change& change :
       {Change([](ModelRecord& m) { m.cap_count = 0; }),
        Change([](ModelRecord& m) { m.cap_block_count = 0; }),
        Change([](ModelRecord& m) { m.cap_page_count = 0; }), Change([](ModelRecord& m) {
          m.unbalanced_edge_count = 0;
          m.unbalanced_edge[0] = {};
        })})
    expect_model_refused(
        [&](ModelRecord& m) {
          open(m);
          change(m);
        },
        "caps are not those");
  expect_model_refused([](ModelRecord& m) { m.cap_node_count = 1; }, "caps are not those");
  for (const double area : {-1.0, kNan, kInfinity})
    expect_model_refused(
        [&](ModelRecord& m) {
          open(m);
          m.cap_area = area;
        },
        "area of the caps");
  expect_model_refused(
      [&](ModelRecord& m) {
        open(m);
        m.cap_count = (std::uint64_t{1} << 32) + 1;
      },
      "more caps than");
  expect_model_refused([](ModelRecord& m) { m.cap_area = 1; }, "area of the caps");
  expect_model_refused([](ModelRecord& m) { m.cap_height = 1; }, "tree of caps");
  expect_model_refused([](ModelRecord& m) { m.cap_reserved[0] = 1; }, "reserved");
}

TEST_F(PageFileRefusal, AcceptsModelsAtTheLimits) {
  FileImage image = good();
  image.change_header([](FileHeader& h) {
    h.page_bytes = kMaxPageBytes;
    h.model.scale_exponent = -1200;
    h.model.height = 96;
    h.model.vertex_kind = VertexKind::kFloat64;
    h.model.triangle_id_bytes = 8;
    h.model.box_lower[0] = h.model.core_lower[0] = h.model.box_upper[0];
  });
  image.seal_header();
  EXPECT_EQ(refusal_of(image).text[0], 0);
}

TEST_F(PageFileRefusal, RefusesADirectoryThatIsNotThatOfTheHeader) {
  FileImage image = good();
  image.change_entry(1, [](DirectoryPage& e) { e.check ^= 1; });
  expect_refused(image, ErrorCode::kDamaged, "hash of a part of the directory");
  for (const int word : {0, 1}) {
    expect_header_refused([&](FileHeader& h) { h.content_id[word] ^= 1; }, ErrorCode::kDamaged,
                          "hash of a part of the directory");
  }
}

TEST_F(PageFileRefusal, RefusesBadPageEntries) {
  expect_entry_refused(
      2, [](DirectoryPage& e) { --e.stored_bytes; }, "do not end where");
  expect_entry_refused(
      0, [](DirectoryPage& e) { e.raw_bytes = 135; }, "raw length is above");
  expect_entry_refused(
      0, [](DirectoryPage& e) { e.raw_bytes = ~0u; }, "raw length is above");
  expect_entry_refused(
      0, [](DirectoryPage& e) { e.raw_bytes = 0; }, "cannot give");
  expect_entry_refused(
      0, [](DirectoryPage& e) { e.stored_bytes = 0; }, "stored length is zero");
  expect_entry_refused(
      0, [](DirectoryPage& e) { e.stored_bytes = ~0u; }, "above the file's largest");
  expect_entry_refused(
      1, [](DirectoryPage& e) { e.raw_bytes = 126; }, "cannot give");
}

TEST_F(PageFileRefusal, RefusesOctcodesOutOfOrder) {
  expect_entry_refused(
      1, [](DirectoryPage& e) { e.octcode = 2; }, "octcode does not follow");
  expect_entry_refused(
      0, [](DirectoryPage& e) { e.octcode = 1; }, "octcode does not follow");
}

// A small page that claims to decode to a mebibyte.
TEST_F(PageFileRefusal, RefusesDecompressionBombs) {
  FileImage image = good();
  image.change_entry(0, [](DirectoryPage& e) { e.raw_bytes = kMaxRawBytes; });
  image.change_header([](FileHeader& h) { h.max_raw_bytes = kMaxRawBytes; });
  image.seal();
  expect_refused(image, ErrorCode::kDamaged, "cannot give");
}

TEST_F(PageFileRefusal, RecognisesADamagedPlanetreeFile) {
  // The first bytes after a transfer in text mode.
  FileImage image = good();
  image.bytes().erase(image.bytes().begin() + 6);
  std::memset(image.bytes().data() + image.bytes().size() - kHeaderBytes, 0, kHeaderBytes);
  expect_refused(image, ErrorCode::kDamaged, "text mode");
  image = good();
  image.bytes()[100] ^= std::byte{1};
  image.bytes()[image.bytes().size() - 1] ^= std::byte{1};
  expect_refused(image, ErrorCode::kDamaged, "neither");
}

TEST_F(PageFileRefusal, RefusesCountsThatContradictEachOther) {
  expect_model_refused([](ModelRecord& m) { m.triangle_count = 0; }, "no triangle");
  expect_model_refused([](ModelRecord& m) { m.node_count = 0; }, "counts of nodes");
  expect_model_refused([](ModelRecord& m) { m.triangle_count = 16; }, "counts of nodes");
  expect_model_refused([](ModelRecord& m) { m.block_count = 0; }, "counts of nodes");
  expect_model_refused([](ModelRecord& m) { m.skipped_count = kNoTriangle; }, "overflow");
  expect_model_refused([](ModelRecord& m) { m.skipped_count = 3; }, "first skipped");
  expect_model_refused([](ModelRecord& m) { m.first_skipped = 3; }, "first skipped");
  expect_model_refused([](ModelRecord& m) { m.sample_triangle = 20; }, "sample triangle");
}

}  // namespace
}  // namespace planetree::storage
