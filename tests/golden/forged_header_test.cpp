// Fields of a header are checked even if its hash is correct.

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

#include "planetree/planetree.h"
#include "storage/file/file_layout.h"
#include "tests/golden/samples.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::golden {
namespace {

// Opens a sample whose header was changed and given its right hash. Returns the error's text, or
// "opened".
std::string open_with(const std::function<void(storage::FileHeader&)>& change) {
  storage::FileImage image(read_file(samples().front().ptree_path()));
  image.change_header([&change](storage::FileHeader& header) {
    change(header);
    header.header_hash = storage::header_hash(header);
  });
  const storage::TemporaryDirectory folder;
  storage::write_bytes(folder / "forged.ptree", image.bytes());
  const auto model = Model::open(folder / "forged.ptree");
  return model ? "opened" : model.error().text;
}

std::string open_with_counts(std::uint64_t nodes, std::uint64_t blocks) {
  return open_with([=](storage::FileHeader& header) {
    header.model.triangle_count = nodes > 0 ? 20 : 4;
    header.model.node_count = nodes;
    header.model.block_count = blocks;
  });
}

TEST(ForgedHeader, MayNotStateMoreRecordsThanItsPagesHold) {
  constexpr std::uint64_t kHalf = std::uint64_t{1} << 63;
  EXPECT_EQ(open_with_counts(0, 1), "opened");
  for (const auto& [nodes, blocks] : {std::pair<std::uint64_t, std::uint64_t>{1 << 20, 1},
                                      {0, 1 << 20},
                                      {kHalf, kHalf},
                                      {~0ull, 1}})
    EXPECT_NE(open_with_counts(nodes, blocks).find("more nodes and blocks"), std::string::npos)
        << nodes << ' ' << blocks;
}

TEST(ForgedHeader, MayNotStateAttributesThatTheFileDoesNotHave) {
  using storage::ModelRecord;
  const std::function<void(ModelRecord&)> changes[] = {
      [](ModelRecord& model) { model.attributes = 1; },
      [](ModelRecord& model) { model.attributes = 2; },
      [](ModelRecord& model) { model.attributes = 16; },
      [](ModelRecord& model) { model.attribute_page_count = 1; },
      [](ModelRecord& model) {
        model.mask_page_count = 0;
        model.mask_cell_count = 0;
        model.attribute_page_count = 1;
      },
      [](ModelRecord& model) { model.value_kind = storage::ValueKind::kReal; },
      [](ModelRecord& model) { model.attribute_reserved[1] = 1; }};
  for (std::size_t i = 0; i < std::size(changes); ++i) {
    EXPECT_NE(open_with([&](storage::FileHeader& header) { changes[i](header.model); }), "opened")
        << i;
  }
}

}  // namespace
}  // namespace planetree::golden
