// The samples are what the builder writes for their meshes, byte for byte. The command
//
//   PLANETREE_UPDATE_SAMPLES=1 golden_tests --gtest_filter='*Sample*'
//
// writes them again and prints the listings of the worked example, to be pasted into
// format-spec/v1/spec.md.

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>

#include "tests/golden/samples.h"
#include "tests/golden/spec_reader.h"
#include "tests/golden/spec_text.h"
#include "tests/golden/worked_example.h"

namespace planetree::golden {
namespace {

bool is_update() { return std::getenv("PLANETREE_UPDATE_SAMPLES") != nullptr; }

class Samples : public testing::TestWithParam<Sample> {};

INSTANTIATE_TEST_SUITE_P(All, Samples, testing::ValuesIn(all_samples()), sample_name);

// Updates before any test runs, because the order of tests is not fixed.
class Update final : public testing::Environment {
 public:
  void SetUp() override {
    if (!is_update()) return;
    for (const Sample& sample : all_samples()) {
      const std::vector<std::byte> bytes = build_bytes(sample, 1);
      std::ofstream(sample.ptree_path(), std::ios::binary)
          .write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    }
  }
};

[[maybe_unused]] const testing::Environment* const kUpdate =
    testing::AddGlobalTestEnvironment(new Update);

TEST_P(Samples, MatchTheBuildersOutput) {
  const Sample& sample = GetParam();
  const std::vector<std::byte> expected = read_file(sample.ptree_path());
  for (const unsigned threads : {1u, 2u})
    EXPECT_EQ(build_bytes(sample, threads), expected)
        << threads << " threads; if pages changed on purpose, or LZ4 did, see the top of this file";
}

TEST(Samples, AreSmall) {
  std::uintmax_t total = 0;
  for (const auto& file :
       std::filesystem::directory_iterator(samples().front().mesh_path().parent_path()))
    total += file.file_size();
  EXPECT_LE(total, 130'000u);
}

TEST(Samples, AreListedInTheReadme) {
  std::ifstream stream(samples().front().mesh_path().parent_path() / "README.md");
  const std::string readme{std::istreambuf_iterator<char>(stream), {}};
  for (const auto& file :
       std::filesystem::directory_iterator(samples().front().mesh_path().parent_path())) {
    const std::string name = file.path().filename();
    if (name == "README.md") continue;
    EXPECT_NE(readme.find("`" + name + "`"), std::string::npos) << name;
  }
}

TEST(SampleListing, MatchesTheWorkedExample) {
  const std::vector<std::byte> bytes = read_file(samples().front().ptree_path());
  const std::string file = list_file(bytes);
  const std::string page = list_page(SpecFile(bytes).raw_page(0));
  if (is_update()) std::cout << "```file\n" << file << "```\n\n```page\n" << page << "```\n";
  EXPECT_EQ(spec_block("file"), file);
  EXPECT_EQ(spec_block("page"), page);
}

}  // namespace
}  // namespace planetree::golden
