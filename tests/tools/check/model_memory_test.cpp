#include "tools/check/model_memory.h"

#include <gtest/gtest.h>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/check/sample_tree.h"

namespace planetree::tools {
namespace {

TEST(ModelMemory, IsAsMuchAsTheModelNeeds) {
  const storage::TemporaryDirectory folder;
  write_mesh(folder / "mesh.obj", 14);
  build_sample(folder / "mesh.obj", folder / "tree.ptree");
  OpenOptions options;
  options.max_probes = 1;
  const auto least = memory_without_limit(1, folder / "tree.ptree", options);
  ASSERT_TRUE(least);
  EXPECT_EQ(*least, *least_memory(folder / "tree.ptree", options));
  options.memory_budget_bytes = *least - 1;
  EXPECT_FALSE(Model::open(folder / "tree.ptree", options));
  options.memory_budget_bytes = *least;
  EXPECT_TRUE(Model::open(folder / "tree.ptree", options));
  EXPECT_EQ(*memory_without_limit(*least + 1, folder / "tree.ptree", options), *least + 1);
  EXPECT_EQ(memory_without_limit(1, folder / "none.ptree", options).error().code,
            ErrorCode::kNotFound);
}

}  // namespace
}  // namespace planetree::tools
