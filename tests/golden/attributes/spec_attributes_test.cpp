// Checks the attributes of files, as the independent reader decodes them, against the tree of the
// file and against the mesh that it was built from.

#include "tests/golden/attributes/spec_attributes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "planetree/planetree.h"
#include "tests/golden/attributes/painted_mesh.h"
#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"
#include "tests/storage/file/file_image.h"

namespace planetree::golden {
namespace {

// The link of the block that has each index, by the tree.
std::map<std::uint64_t, SpecLink> links_by_tree(const SpecFile& file) {
  std::map<std::uint64_t, SpecLink> links;
  const SpecTree tree(file);
  for (const SpecPage& page : tree.pages())
    for (const auto& [link, block] : page.blocks)
      for (const SpecTriangle& triangle : block.triangles) links[triangle.id] = link;
  return links;
}

void expect_links_to_blocks(const SpecFile& file) {
  const std::map<std::uint64_t, SpecLink> expected = links_by_tree(file);
  const SpecAttributes attributes(file);
  ASSERT_EQ(attributes.size(), file.header().indices());
  ASSERT_EQ(expected.size(), file.header().triangle_count);
  for (std::uint64_t index = 0; index < attributes.size(); ++index) {
    const auto found = expected.find(index);
    EXPECT_EQ(attributes.link(index), found == expected.end() ? kNoBlock : found->second) << index;
  }
}

class SpecLinks : public testing::TestWithParam<Sample> {
 protected:
  static SpecFile file_with(std::uint32_t page_bytes, std::uint32_t keep) {
    const Sample& sample = GetParam();
    return SpecFile(build_bytes(sample.mesh_path(), page_bytes, 1, sample.box, kAllLayers, keep));
  }
};

INSTANTIATE_TEST_SUITE_P(All, SpecLinks, testing::ValuesIn(all_samples()), sample_name);

TEST_P(SpecLinks, LeadToTheBlocksOfTriangles) {
  for (const std::uint32_t page_bytes : {4096u, 65536u}) {
    const SpecFile file = file_with(page_bytes, kKeepTriangles);
    EXPECT_EQ(file.header().attributes, 1u);
    expect_links_to_blocks(file);
  }
}

// "Layout": attribute pages come after the pages that they do not change.
TEST_P(SpecLinks, LeaveTheTreeAndTheFieldAsTheyAre) {
  const SpecFile file = file_with(4096, kKeepTriangles), plain = file_with(4096, 0);
  EXPECT_EQ(plain.header().attributes, 0u);
  EXPECT_EQ(SpecAttributes(plain).size(), 0u);
  ASSERT_EQ(file.header().a(), plain.header().a());
  EXPECT_EQ(file.header().mask_pages, plain.header().mask_pages);
  for (std::uint32_t page = 0; page < file.header().a(); ++page)
    EXPECT_EQ(file.raw_page(page), plain.raw_page(page)) << page;
}

class SpecPainted : public testing::Test {
 protected:
  const SpecFile file_{read_file(painted_sample().ptree_path())};
  const SpecAttributes attributes_{file_};
  const std::vector<std::optional<PaintedTriangle>> mesh_ = painted_triangles();
};

TEST_F(SpecPainted, FileHasAllAttributesInTwoPages) {
  EXPECT_EQ(file_.header().attributes, 15u);
  EXPECT_EQ(file_.header().value_kind, 2u);
  EXPECT_EQ(file_.header().attribute_pages, 2u);
  EXPECT_EQ(file_.header().skipped_count, 2u);
  EXPECT_EQ(attributes_.size(), 96u);
  expect_links_to_blocks(file_);
}

TEST_F(SpecPainted, AttributesAreThoseOfTheMesh) {
  ASSERT_EQ(attributes_.size(), mesh_.size());
  for (std::uint64_t index = 0; index < mesh_.size(); ++index) {
    const PaintedTriangle expected = mesh_[index].value_or(PaintedTriangle{});
    EXPECT_EQ(attributes_.colours(index), expected.colours) << index;
    EXPECT_EQ(attributes_.uvs(index), expected.uvs) << index;
    EXPECT_EQ(attributes_.value(index), std::bit_cast<std::uint64_t>(expected.value)) << index;
    EXPECT_EQ(attributes_.link(index) == kNoBlock, !mesh_[index].has_value()) << index;
  }
}

TEST_F(SpecPainted, LinksGiveTheCornersInTheirOrder) {
  const SpecTree tree(file_);
  for (std::uint64_t index = 0; index < mesh_.size(); ++index) {
    if (!mesh_[index]) continue;
    std::array<SpecPoint, 3> corners = mesh_[index]->corners;
    for (SpecPoint& corner : corners)
      for (double& coordinate : corner)
        coordinate = std::ldexp(coordinate, file_.header().scale_exponent);
    const std::vector<SpecTriangle>& block = tree.block(attributes_.link(index)).triangles;
    const auto found = std::ranges::find(block, index, &SpecTriangle::id);
    ASSERT_NE(found, block.end()) << index;
    EXPECT_EQ(found->corners, corners) << index;
  }
}

TEST_F(SpecPainted, LibraryGivesTheSameTriangles) {
  const auto model = Model::open(painted_sample().ptree_path());
  ASSERT_TRUE(model) << model.error().text;
  for (std::uint64_t index = 0; index < mesh_.size(); ++index) {
    const auto triangle = model->triangle(index);
    ASSERT_EQ(static_cast<bool>(triangle), mesh_[index].has_value()) << index;
    if (!triangle) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto [red, green, blue, alpha] = triangle->colors[k];
      EXPECT_EQ(attributes_.colours(index)[k], (SpecColour{red, green, blue, alpha})) << index;
      EXPECT_EQ(attributes_.uvs(index)[k], (SpecUv{triangle->uvs[k].u, triangle->uvs[k].v}));
      const auto [x, y, z] = triangle->corners[k];
      EXPECT_EQ(mesh_[index]->corners[k], (SpecPoint{x, y, z})) << index;
    }
    EXPECT_EQ(attributes_.value(index), triangle->value) << index;
  }
}

// The text with which the reader refuses the sample after a change of its header, or nothing.
std::string refusal_of_header(const std::function<void(storage::FileHeader&)>& change) {
  storage::FileImage image(read_file(painted_sample().ptree_path()));
  image.change_header(change);
  image.seal_header();
  try {
    const SpecFile file(image.bytes());
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return {};
}

std::string refusal_of_model(const std::function<void(storage::ModelRecord&)>& change) {
  return refusal_of_header([&change](storage::FileHeader& header) { change(header.model); });
}

TEST(SpecAttributeFields, AreRefusedBeyondTheirRanges) {
  using storage::ModelRecord;
  const auto attributes = [](std::uint8_t bits) {
    return refusal_of_model([bits](ModelRecord& model) { model.attributes = bits; });
  };
  const auto pages = [](std::uint32_t count) {
    return refusal_of_model([count](ModelRecord& model) { model.attribute_page_count = count; });
  };
  EXPECT_EQ(refusal_of_header([](storage::FileHeader&) {}), "");
  EXPECT_EQ(attributes(14), "attributes without links");
  for (const int bit : {16, 32, 64, 128})
    EXPECT_EQ(attributes(static_cast<std::uint8_t>(15 | bit)), "an unknown attribute");
  for (const std::uint32_t count : {0u, 1u, 3u, ~0u})
    EXPECT_EQ(pages(count), "pages of attributes");
  EXPECT_EQ(attributes(0), "kind of values");
  const auto value_kind = [](std::uint8_t kind) {
    return refusal_of_model(
        [kind](ModelRecord& model) { std::memcpy(&model.value_kind, &kind, 1); });
  };
  EXPECT_EQ(value_kind(1), "");
  EXPECT_EQ(value_kind(3), "kind of values");
  for (const std::size_t at : {0, 1})
    EXPECT_EQ(refusal_of_model([at](ModelRecord& model) { model.attribute_reserved[at] = 1; }),
              "reserved bytes of attributes");
  for (const std::size_t at : {0, 255})
    EXPECT_EQ(refusal_of_header([at](storage::FileHeader& header) {
                reinterpret_cast<std::byte*>(&header)[760 + at] = std::byte{1};
              }),
              "reserved bytes of the header");
}

// "Page keys": the octcode of an attribute page is 0.
TEST(SpecAttributeFields, AreKeysOfAttributePages) {
  const std::uint32_t first = SpecFile(read_file(painted_sample().ptree_path())).header().a();
  const auto opens_with = [first](const std::function<void(storage::DirectoryPage&)>& change) {
    storage::FileImage image(read_file(painted_sample().ptree_path()));
    image.change_entry(first + 1, change);
    image.seal();
    try {
      return SpecFile(image.bytes()).header().attributes != 0;
    } catch (const std::runtime_error& error) {
      EXPECT_STREQ(error.what(), "key of a field page or an attribute page");
      return false;
    }
  };
  EXPECT_TRUE(opens_with([](storage::DirectoryPage&) {}));
  EXPECT_FALSE(opens_with([](storage::DirectoryPage& entry) { entry.octcode = 1; }));
}

}  // namespace
}  // namespace planetree::golden
