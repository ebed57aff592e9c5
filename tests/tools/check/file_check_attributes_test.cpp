#include <gtest/gtest.h>

#include <cstring>

#include "octree/attributes/attribute_page.h"
#include "planetree/build.h"
#include "tests/tools/check/mask_check_fixture.h"

// Issues that verify finds in attribute pages.
namespace planetree::tools {
namespace {

class FileCheckOfAttributes : public FileCheckOfMasks {
 protected:
  // A sphere that keeps where its triangles are.
  std::filesystem::path kept() {
    const std::filesystem::path tree = folder_ / "kept.ptree";
    if (std::filesystem::exists(tree)) return tree;
    write_soup(folder_ / "kept.obj", octree::sphere(4));
    BuildOptions options;
    options.page_bytes = 4096;
    options.keep = kKeepTriangles;
    const auto report = build(folder_ / "kept.obj", tree, options);
    EXPECT_TRUE(report) << report.error().text;
    return tree;
  }
  using StoredLink = octree::StoredLink;

  // Changes a link of the first attribute page: a page in 4 bytes and a block in 2. Byte k of
  // triangle i is at k n + i behind the head.
  static Forgery forged_link(std::uint32_t triangle,
                             const std::function<StoredLink(StoredLink)>& change) {
    Forgery forgery;
    forgery.attributes = [=](std::uint32_t page, std::vector<std::byte>& raw) {
      if (page != 0) return;
      octree::AttributePageHead head;
      std::memcpy(&head, raw.data(), sizeof head);
      StoredLink link;
      const auto at = [&](unsigned k) -> std::byte& {
        return raw[sizeof head + k * head.triangle_count + triangle];
      };
      for (unsigned k = 0; k < 4; ++k) link.page |= static_cast<std::uint32_t>(at(k)) << (8 * k);
      link.record = static_cast<std::uint16_t>(static_cast<unsigned>(at(4)) |
                                               static_cast<unsigned>(at(5)) << 8);
      link = change(link);
      for (unsigned k = 0; k < 4; ++k) at(k) = static_cast<std::byte>(link.page >> (8 * k));
      for (unsigned k = 0; k < 2; ++k) at(4 + k) = static_cast<std::byte>(link.record >> (8 * k));
    };
    return forgery;
  }
};

TEST_F(FileCheckOfAttributes, FindsNothingInSoundFiles) {
  const CheckReport report = check_path(kept(), true);
  EXPECT_EQ(codes_of(report), Codes{});
  EXPECT_EQ(codes_of(check_forgery(kept(), {}, true)), Codes{});
}

TEST_F(FileCheckOfAttributes, FindsLinksToOtherBlocksAndMissingOnes) {
  const StoredLink other = [&] {
    StoredLink found;
    check_forgery(kept(), forged_link(900, [&](StoredLink link) { return found = link; }), false);
    return found;
  }();
  const auto to_other = forged_link(0, [=](StoredLink) { return other; });
  EXPECT_EQ(codes_of(check_forgery(kept(), to_other, true)), Codes{"ATTRIBUTES"});
  EXPECT_EQ(codes_of(check_forgery(kept(), to_other, false)), Codes{});
  const auto beyond = forged_link(0, [](StoredLink link) { return StoredLink{link.page, 15}; });
  EXPECT_EQ(codes_of(check_forgery(kept(), beyond, true)), Codes{"ATTRIBUTES"});
  const auto to_none = forged_link(0, [](StoredLink) { return octree::kNoStoredLink; });
  EXPECT_EQ(codes_of(check_forgery(kept(), to_none, true)), Codes{"ATTRIBUTES"});
}

TEST_F(FileCheckOfAttributes, FindsPagesWithBadStructure) {
  const auto too_far = forged_link(0, [](StoredLink link) { return StoredLink{link.page, 16}; });
  EXPECT_EQ(codes_of(check_forgery(kept(), too_far, false)), Codes{"PAGE_STRUCTURE"});
  Forgery forgery;
  forgery.attributes = [](std::uint32_t, std::vector<std::byte>& raw) { raw.pop_back(); };
  EXPECT_EQ(codes_of(check_forgery(kept(), forgery, false)), Codes{"PAGE_STRUCTURE"});
}

}  // namespace
}  // namespace planetree::tools
