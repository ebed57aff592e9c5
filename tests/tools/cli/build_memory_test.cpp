#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/storage/system/temporary_directory.h"

namespace planetree::tools {
namespace {

// A debug build is slow, and sanitizers take memory.
#if defined(PLANETREE_COMMAND) && defined(NDEBUG)

// The edges of a soup are all unbalanced, and it has as many caps as triangles.
TEST(BuildMemory, HoldsTheEdgesAndCapsOfASoup) {
  const storage::TemporaryDirectory folder;
  const auto succeeds = [&](const std::string& arguments) {
    return std::system(("cd '" + (folder / ".").string() + "' && '" PLANETREE_COMMAND "' " +
                        arguments + " >report 2>errors")
                           .c_str()) == 0;
  };
  ASSERT_TRUE(succeeds("generate soup.ply --shape soup --triangles 500K --quiet"));
  ASSERT_TRUE(succeeds("build soup.ply -o soup.ptree --memory 160M --json"));
  std::ifstream report(folder / "report");
  const auto figures = nlohmann::json::parse(report);
  EXPECT_EQ(figures["unbalanced_edges"], 1500000);
  EXPECT_LE(figures["peak_resident_bytes"], 160 << 20);
}

#endif

}  // namespace
}  // namespace planetree::tools
