// Fields of a header are checked even if its hash is correct.

#include <gtest/gtest.h>

#include <cstdint>
#include <string>

#include "planetree/planetree.h"
#include "storage/file/file_layout.h"
#include "tests/golden/samples.h"
#include "tests/storage/file/file_image.h"
#include "tests/storage/system/temporary_directory.h"

namespace planetree::golden {
namespace {

// Returns the error's text, or "opened".
std::string open_with_root_link(std::uint32_t link) {
  storage::FileImage image(read_file(samples().front().ptree_path()));
  image.change_header([link](storage::FileHeader& header) {
    header.model.root_link = link;
    header.header_hash = storage::header_hash(header);
  });
  const storage::TemporaryDirectory folder;
  storage::write_bytes(folder / "forged.ptree", image.bytes());
  const auto model = Model::open(folder / "forged.ptree");
  return model ? "opened" : model.error().text;
}

TEST(ForgedHeader, MustHaveItsRootOnPageZero) {
  EXPECT_EQ(open_with_root_link(0x80000002), "opened");
  for (const std::uint32_t page : {1u, 2u, 500'000u, (1u << 25) - 1})
    EXPECT_NE(open_with_root_link(0x80000002 | page << 6).find("root"), std::string::npos) << page;
}

}  // namespace
}  // namespace planetree::golden
